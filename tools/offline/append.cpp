// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/append.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::tools {

Drives::Drives(std::vector<Trajectory*> sensors, std::vector<std::string> names)
    : sensors_(std::move(sensors)) {
  note(std::move(names), {sensors_.begin(), sensors_.end()}, std::vector<std::size_t>(sensors_.size(), 0));
}

void Drives::note(std::vector<std::string> names, const std::vector<const Trajectory*>& drive,
                  std::vector<std::size_t> begin) {
  Drive noted{std::move(names), {}, std::move(begin)};
  for (const Trajectory* trajectory : drive) noted.spans.push_back(span_in_words(*trajectory));
  drives_.push_back(std::move(noted));
}

void Drives::append(std::vector<Trajectory> drive, std::vector<std::string> names) {
  constexpr std::int64_t gap_us = 3'600'000'000;  // [us] an hour: no motion spans it
  std::int64_t end = std::numeric_limits<std::int64_t>::min(),
               begin = std::numeric_limits<std::int64_t>::max();
  std::vector<std::size_t> sizes;
  std::vector<const Trajectory*> parts;
  for (const Trajectory* sensor : sensors_) {
    if (!sensor->empty()) end = std::max(end, sensor->back().time_us);
    sizes.push_back(sensor->size());
  }
  for (const Trajectory& trajectory : drive) {
    if (!trajectory.empty()) begin = std::min(begin, trajectory.front().time_us);
    parts.push_back(&trajectory);
  }
  note(std::move(names), parts, std::move(sizes));
  // the same shift for all sensors keeps them synchronised
  const std::int64_t shift = end - begin + gap_us;
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    for (const StampedPose& pose : drive[i]) sensors_[i]->push_back({pose.time_us + shift, pose.pose});
}

Trajectory Drives::part(const Trajectory& stream, std::size_t drive, std::size_t sensor) const {
  const auto at = [&](std::size_t i) { return stream.begin() + static_cast<std::ptrdiff_t>(i); };
  const bool last = drive + 1 == drives_.size();
  return {at(drives_[drive].begin[sensor]), last ? stream.end() : at(drives_[drive + 1].begin[sensor])};
}

void Drives::require_motions(std::size_t sensor_a, std::size_t sensor_b, const Trajectory& a,
                             const Trajectory& b, PairingOptions pairing) const {
  if (drives_.size() < 2) return;
  pairing.stride = 1;  // the shortest motions: a drive may be shorter than those that are chosen
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const PairingResult result = pair_motions(pairing, part(a, k, sensor_a), part(b, k, sensor_b));
    if (!result.pairs.empty()) continue;
    const Drive& drive = drives_[k];
    throw Error(fmt::format("{}{}, {}: no motion pairs in this drive; a: {}, b: {}; {}: leave it out",
                            k > 0 ? "--append: " : "", drive.names[sensor_a], drive.names[sensor_b],
                            drive.spans[sensor_a], drive.spans[sensor_b],
                            rejections_in_words(result.drive.counts())));
  }
}

}  // namespace egocal::tools
