// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/drives/append.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::tools {

namespace {

/// A pose, and when the sensor was there first [us].
struct Seen {
  std::array<double, 8> numbers{};
  std::int64_t time_us = 0;
};

bool precedes(const Seen& x, const Seen& y) {
  return x.numbers < y.numbers;
}

/// The different poses of a drive, sorted. A sensor that stands repeats them.
std::vector<Seen> different_poses(const Trajectory& trajectory) {
  std::vector<Seen> places;
  places.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) {
    Seen place{{}, pose.time_us};
    const auto vec = pose.pose.vec();
    for (std::size_t i = 0; i < place.numbers.size(); ++i)
      place.numbers[i] = vec[static_cast<Eigen::Index>(i)];
    places.push_back(place);
  }
  std::stable_sort(places.begin(), places.end(), precedes);
  const auto same = [](const Seen& x, const Seen& y) { return x.numbers == y.numbers; };
  places.erase(std::unique(places.begin(), places.end(), same), places.end());
  return places;
}

}  // namespace

Drives::Drives(std::vector<Trajectory*> sensors, std::vector<std::string> names)
    : sensors_(std::move(sensors)) {
  note(std::move(names), {sensors_.begin(), sensors_.end()}, std::vector<std::size_t>(sensors_.size(), 0), 0);
}

void Drives::note(std::vector<std::string> names, const std::vector<const Trajectory*>& drive,
                  std::vector<std::size_t> begin, std::int64_t shift_us) {
  Drive noted{std::move(names), {}, std::move(begin)};
  if (const Trajectory& first = *drive.front(); !first.empty()) {
    const std::int64_t origin_us = sensors_.front()->front().time_us;
    noted.from = to_seconds(first.front().time_us + shift_us - origin_us);
    noted.to = to_seconds(first.back().time_us + shift_us - origin_us);
  }
  for (const Trajectory* trajectory : drive) noted.spans.push_back(span_in_words(*trajectory));
  drives_.push_back(std::move(noted));
}

Drives::Repeated Drives::repeated(const Trajectory& trajectory, std::size_t drive, std::size_t sensor) const {
  const std::vector<Seen> places = different_poses(trajectory),
                          others = different_poses(part(*sensors_[sensor], drive, sensor));
  std::vector<std::int64_t> shifts;
  for (const Seen& place : places) {
    const auto other = std::lower_bound(others.begin(), others.end(), place, precedes);
    if (other != others.end() && other->numbers == place.numbers)
      shifts.push_back(other->time_us - place.time_us);
  }
  if (shifts.empty()) return {};
  const double part = static_cast<double>(shifts.size()) / static_cast<double>(places.size());
  return {part, detail::median(std::move(shifts))};
}

bool Drives::is_repeated(const std::vector<Trajectory>& drive, const std::vector<std::string>& names,
                         std::vector<std::string>& notes) const {
  constexpr double few = 0.1;  // an odometry begins at zero each time, and rounded poses may meet
  constexpr std::int64_t same_clock_us = 1000;  // [us] far below the period of any odometry
  std::vector<std::string> shared;
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    bool all = true;
    std::optional<std::int64_t> shift_us;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      const Repeated found = repeated(drive[i], k, i);
      // of two clocks that were moved against each other it is another measurement, if a wrong one
      all = all && found.part == 1 &&
            std::abs(found.shift_us - shift_us.value_or(found.shift_us)) <= same_clock_us;
      shift_us = found.shift_us;
      if (found.part > few)
        shared.push_back(fmt::format(
            "--append: {}: {:.0f} % of its poses are those of {}, and count twice: the standard deviations "
            "are too small",
            names[i], 100 * found.part, drives_[k].names[i]));
    }
    if (!all) continue;
    notes.push_back(fmt::format("--append: {}: the same recording as {}: omitted, it shows nothing new",
                                fmt::join(names, ", "), fmt::join(drives_[k].names, ", ")));
    return true;
  }
  notes.insert(notes.end(), shared.begin(), shared.end());
  return false;
}

void Drives::append(std::vector<Trajectory> drive, std::vector<std::string> names,
                    std::vector<std::string>& notes) {
  if (is_repeated(drive, names, notes)) return;
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
  // the same shift for all sensors keeps them synchronised
  const std::int64_t shift = end - begin + gap_us;
  note(std::move(names), parts, std::move(sizes), shift);
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    for (const StampedPose& pose : drive[i]) sensors_[i]->push_back({pose.time_us + shift, pose.pose});
}

Trajectory Drives::part(const Trajectory& stream, std::size_t drive, std::size_t sensor) const {
  const auto at = [&](std::size_t i) { return stream.begin() + static_cast<std::ptrdiff_t>(i); };
  const bool last = drive + 1 == drives_.size();
  return {at(drives_[drive].begin[sensor]), last ? stream.end() : at(drives_[drive + 1].begin[sensor])};
}

std::string Drives::place_of(double seconds) const {
  if (drives_.size() < 2) return {};
  std::size_t k = drives_.size() - 1;
  while (k > 0 && seconds < drives_[k].from) --k;
  const Drive& drive = drives_[k];
  if (seconds <= drive.to || k + 1 == drives_.size())
    return fmt::format("{:.1f} s into {}", seconds - drive.from, drive.names.front());
  return fmt::format("between {} and {}", drive.names.front(), drives_[k + 1].names.front());
}

double Drives::driven_part() const {
  double driven = 0;
  for (const Drive& drive : drives_) driven += drive.to - drive.from;
  const double all = drives_.back().to - drives_.front().from;
  return all > 0 ? driven / all : 1;
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
