// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/contradicting_parts.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/statistics/median.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

/// What the answer leaves of the rotations of one part of the drive [rad], and as a part of what is turned.
struct PartResidual {
  std::size_t count = 0;  ///< of motions that are not at rest; 0: most of them are
  double rotation = 0, relative = 0;
};

struct TimeSpan {
  double begin = 0, end = 0;  ///< [s]
};

std::vector<PartResidual> residuals_of_parts(const Motions& motions, const Pose& T_a_b, const TimeSpan& drive,
                                             const ContradictingPartsOptions& tuning) {
  const std::size_t parts = tuning.parts;
  std::vector<std::vector<double>> rotations(parts), angles(parts);
  std::vector<std::size_t> all(parts);
  const std::vector<bool> rest = at_rest(motions, T_a_b), one_rests = one_at_rest(motions);
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    const Motion& motion = motions.all[i];
    const double place = static_cast<double>(parts) * (motion.time - drive.begin) / (drive.end - drive.begin);
    if (place < 0) continue;
    const std::size_t part = std::min(parts - 1, static_cast<std::size_t>(place));
    ++all[part];
    if (rest[i] || one_rests[i]) continue;
    rotations[part].push_back(residual_at(motion, T_a_b).rotation);
    angles[part].push_back(std::min(motion.angle_a, motion.angle_b));
  }
  // of parts that hardly turn nothing is left for each degree
  const double least_angle = tuning.least_turning * usual_angle(motions);
  std::vector<PartResidual> result;
  for (std::size_t part = 0; part < parts; ++part) {
    const auto moving = static_cast<double>(rotations[part].size());
    const bool counts = moving >= tuning.least_moving * static_cast<double>(all[part]);
    PartResidual residual{counts ? rotations[part].size() : 0, quantile(rotations[part], tuning.quantile), 0};
    const double angle = std::max(least_angle, median(std::move(angles[part])));
    residual.relative = angle > 0 ? residual.rotation / angle : 0;
    result.push_back(residual);
  }
  return result;
}

double median_of(const std::vector<PartResidual>& parts, std::size_t least, double PartResidual::*value) {
  std::vector<double> values;
  for (const PartResidual& part : parts)
    if (part.count >= least) values.push_back(part.*value);
  return median(std::move(values));
}

}  // namespace

ContradictingParts contradicting_parts(const Instants& instants, int stride, const Pose& T_a_b,
                                       const MotionSampleOptions& options,
                                       const ContradictingPartsOptions& tuning) {
  const Motions motions = motions_of(instants, {}, {}, stride, options.most, options),
                shorter =
                    motions_of(instants, {}, {}, std::max(1, stride / tuning.shorter), options.most, options);
  if (motions.all.size() < tuning.parts * tuning.least) return {};
  const TimeSpan drive{motions.all.front().time, motions.all.back().time};
  if (!(drive.end > drive.begin)) return {};
  const std::vector<PartResidual> parts = residuals_of_parts(motions, T_a_b, drive, tuning),
                                  of_shorter = residuals_of_parts(shorter, T_a_b, drive, tuning);
  const double relative = median_of(parts, tuning.least, &PartResidual::relative),
               relative_shorter = median_of(of_shorter, tuning.least, &PartResidual::relative);
  ContradictingParts found;
  found.others = median_of(parts, tuning.least, &PartResidual::rotation);
  const double width = (drive.end - drive.begin) / static_cast<double>(tuning.parts);
  for (std::size_t k = 0; k < tuning.parts; ++k) {
    const PartResidual& here = parts[k];
    if (here.count < tuning.least || here.rotation < tuning.least_rotation ||
        here.rotation < tuning.times * found.others || here.relative < tuning.times * relative ||
        of_shorter[k].relative < tuning.times_of_shorter * relative_shorter)
      continue;
    const double begin = drive.begin + static_cast<double>(k) * width;
    found.parts.push_back({begin, begin + width, here.rotation});
  }
  return found;
}

std::optional<Finding> contradicting_parts_finding(const ContradictingParts& found) {
  if (found.parts.empty()) return std::nullopt;
  std::string list;
  for (const ContradictingPart& part : found.parts)
    list += format("%s%.2g deg from %.1f to %.1f s", list.empty() ? "" : ", ",
                   part.rotation * degrees_per_radian, part.begin, part.end);
  Finding finding;
  finding.code = "mount_moved";
  finding.time = found.parts.front().begin;
  finding.message = format(
      "These motions contradict each other: the answer leaves %s, and %.2g deg in most of the drive. "
      "A sensor was moved, or its odometry was lost.",
      list.c_str(), found.others * degrees_per_radian);
  finding.remedy = "Calibrate the parts of the drive separately, and compare their answers.";
  return finding;
}

}  // namespace egocal::detail
