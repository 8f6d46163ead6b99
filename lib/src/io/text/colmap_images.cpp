// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/colmap_images.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/io/checked_pose.hpp"
#include "egocal/microseconds.hpp"
#include "io/text.hpp"
#include "io/text/line_reader.hpp"

namespace egocal::detail {

namespace {

struct Image {
  std::string number;  ///< the last one in the name
  double value = 0;    ///< of it
  long line = 0;
  DualQuaternion T_world_camera;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The last number in the name of an image without its extension: "cam0/1403636579763555584.png",
/// "frame_000123.jpg", "1311868164.363181.png". Empty: none.
std::string number_in_name(std::string_view name) {
  const std::size_t folder = name.find_last_of('/');
  if (folder != std::string_view::npos) name.remove_prefix(folder + 1);
  // an extension is no number
  const std::size_t dot = name.find_last_of('.');
  if (dot != std::string_view::npos &&
      !std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(), is_digit))
    name = name.substr(0, dot);
  std::size_t end = name.size();
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  bool point = false;
  while (begin > 0 && (is_digit(name[begin - 1]) ||
                       (!point && name[begin - 1] == '.' && begin > 1 && is_digit(name[begin - 2])))) {
    point = point || name[begin - 1] == '.';
    --begin;
  }
  return std::string(name.substr(begin, end - begin));
}

/// Numbers as large as the seconds since 2001, or finer units of them, are times.
std::optional<TimeUnit> unit_of(double largest) {
  if (largest < 1e9) return std::nullopt;
  if (largest < 4.1e9) return TimeUnit::seconds;
  if (largest < 4.1e12) return TimeUnit::milliseconds;
  return largest < 4.1e15 ? TimeUnit::microseconds : TimeUnit::nanoseconds;
}

std::vector<Image> read_images(ByteSource& source, ReadLosses& losses) {
  std::vector<Image> images;
  LineReader lines(source);
  std::string_view line;
  std::vector<std::string_view> row;
  while (lines.next(line)) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    split(line, ' ', row);
    if (row.size() < 10) {
      if (!lines.terminated() && !images.empty()) {
        losses.truncated = true;
        break;
      }
      throw error_at(source.file(), lines.number(), "",
                     "expected 10 fields (IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME), got " +
                         std::to_string(row.size()));
    }
    constexpr std::array<const char*, 7> names{"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] = number(source.file(), lines.number(), names[i], row[i + 1]);
    const CheckedPose T_camera_world = checked_pose({v[4], v[5], v[6]}, {v[0], v[1], v[2], v[3]});
    if (!T_camera_world.reason.empty())
      throw error_at(source.file(), lines.number(), "", T_camera_world.reason);
    Image image{number_in_name(row[9]), 0, lines.number(), conjugate(T_camera_world.pose)};
    if (image.number.empty() || !parse_number(image.number, image.value))
      throw error_at(source.file(), lines.number(), "NAME",
                     "expected a time or the number of a frame in the image's name, got " + quoted(row[9]));
    images.push_back(std::move(image));
    lines.next(line);  // the points seen in it; the line is empty where there are none
  }
  return images;
}

}  // namespace

ColmapImages::ColmapImages(std::unique_ptr<ByteSource> source, const ReadOptions& options)
    : Recording(source->file()), source_(std::move(source)) {
  if (!options.times_file.empty())
    throw error_at(file_, 0, "--times",
                   "the images of COLMAP have times in their names, or numbers of frames at --rate");
  if (options.rate != 0 && !rates_of_poses.contains(options.rate))
    throw error_at(file_, 0, "--rate", "expected 0.001 to 1e6 Hz");
  rate_given_ = options.rate > 0;
  if (rate_given_) rate_ = options.rate;
}

std::vector<std::string> ColmapImages::unused(const ReadOptions& options) const {
  std::vector<std::string> unused;
  if (!options.columns.empty()) unused.emplace_back("--columns is not used: COLMAP's fields are known");
  if (options.rate > 0 && times_in_names_)
    unused.emplace_back("--rate is not used: the names of the images are times");
  return unused;
}

void ColmapImages::read(const std::string& topic, const TakePose& take) {
  if (!topic.empty())
    throw error_at(file_, 0, "", "is a file of format " + format() + " without topics, got ':" + topic + "'");
  if (read_before_) source_->rewind();
  read_before_ = true;
  streams_.assign(1, {});
  streams_[0].type = format();
  streams_[0].poses = true;
  losses_ = {};
  notes_ = {
      "the poses are world-to-camera and are inverted",
      "the scale of a COLMAP model is arbitrary: egocal solve finds it, --scale-a auto where this is A, "
      "--scale-b auto where it is B"};

  std::vector<Image> images;
  source_->read_content([&] { images = read_images(*source_, losses_); });
  source_->count_unpacking(losses_);
  if (images.empty()) throw error_at(file_, 0, "", source_->why_empty());

  double largest = 0;
  for (const Image& image : images) largest = std::max(largest, image.value);
  const std::optional<TimeUnit> unit = unit_of(largest);
  times_in_names_ = unit.has_value();
  if (!unit)
    notes_.push_back("the numbers in the names are taken as frames at " + std::to_string(std::lround(rate_)) +
                     " Hz" + (rate_given_ ? "" : " (--rate)"));
  std::vector<StampedPose> poses;
  poses.reserve(images.size());
  for (const Image& image : images) {
    double frame = 0;
    parse_number(image.number, frame);
    StampedPose pose;
    pose.time_us = unit ? time_us(file_, image.line, image.number, *unit) : to_microseconds(frame / rate_);
    pose.pose = image.T_world_camera;
    poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& x, const StampedPose& y) { return x.time_us < y.time_us; });
  for (const StampedPose& pose : poses) {
    ++streams_[0].messages;
    take(0, pose);
  }
}

}  // namespace egocal::detail
