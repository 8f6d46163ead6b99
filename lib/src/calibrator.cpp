// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "calibration/steps.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/scale/scale_statistics.hpp"

namespace egocal {

using detail::answered;
using detail::as_read;
using detail::diagnose_without_poses;
using detail::judged;
using detail::solved;

struct Calibrator::Impl {
  CalibrationOptions options;
  MotionPairing pairing;
};

namespace {

PairingOptions pairing_options(const CalibrationOptions& options) {
  PairingOptions pairing = options.pairing;
  if (options.estimate_time_offset) pairing.track_time_offset = true;
  return pairing;
}

}  // namespace

Calibrator::Calibrator(CalibrationOptions options) {
  if (options.estimate_scale)
    throw Error("estimate_scale: the whole drive shows it; give `scale`, or use calibrate()");
  MotionPairing pairing(pairing_options(options));
  impl_.reset(new Impl{std::move(options), std::move(pairing)});
}
Calibrator::~Calibrator() = default;
Calibrator::Calibrator(Calibrator&&) noexcept = default;
Calibrator& Calibrator::operator=(Calibrator&&) noexcept = default;

void Calibrator::add(Side side, const StampedPose& pose) {
  const CalibrationOptions& options = impl_->options;
  const Reading& reading = side == Side::a ? options.read_a : options.read_b;
  StampedPose understood = pose;
  if (!as_read(reading)) understood = reread({understood}, reading).front();
  if (options.scale_side == side && options.scale != 1)
    understood.pose = scaled(understood.pose, options.scale);
  impl_->pairing.push(side, understood);
}

void Calibrator::finish() {
  impl_->pairing.finish();
}

PairingCounts Calibrator::counts() const {
  return impl_->pairing.counts();
}

std::optional<Calibration> Calibrator::answer() const {
  const MotionPairing& pairing = impl_->pairing;
  Problem problem = pairing.problem();
  if (problem.blocks.empty()) return std::nullopt;
  Calibration result = solved(std::move(problem), pairing.choice(), pairing.counts(), impl_->options.method);
  result.time_offset_applied = pairing.time_offset().value_or(0);
  result.scale_applied = impl_->options.scale;
  return judged(result, diagnose_without_poses(answered(result, pairing.single_stride_problem()),
                                               impl_->options.diagnosis));
}

}  // namespace egocal
