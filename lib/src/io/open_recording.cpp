// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "egocal/error.hpp"
#include "egocal/io/recording.hpp"
#include "io/bag/bag_recording.hpp"
#include "io/bag/mcap_reader.hpp"
#include "io/bag/rosbag1_reader.hpp"
#include "io/bag/rosbag2_reader.hpp"
#include "io/text/colmap_images.hpp"
#include "io/text/text_recording.hpp"

namespace egocal {

namespace {

namespace fs = std::filesystem;
using detail::ByteSource;

bool begins_with(ByteSource& source, std::string_view magic) {
  const detail::ByteSpan first = source.peek(magic.size());
  return std::equal(magic.begin(), magic.end(), first.begin(), first.end(),
                    [](char x, unsigned char y) { return static_cast<unsigned char>(x) == y; });
}

/// The reader of a bag; empty where the file is none. Takes the source only where it is one.
std::unique_ptr<detail::MessageReader> open_bag(std::unique_ptr<ByteSource>& source, std::string& format) {
  if (begins_with(*source, detail::mcap_magic)) {
    format = "MCAP";
    return std::make_unique<detail::McapReader>(std::move(source));
  }
  if (begins_with(*source, detail::rosbag1_magic)) {
    format = "rosbag 2.0 (ROS 1)";
    return std::make_unique<detail::Rosbag1Reader>(std::move(source));
  }
  if (begins_with(*source, "#ROSBAG"))
    throw error_at(source->file(), 0, "", "is a ROS bag of an old format; convert it with `rosbag fix`");
  if (begins_with(*source, detail::sqlite_magic)) {
    if (source->plain_size() == 0)
      throw error_at(source->file(), 0, "", "is a packed database; unpack it first (gunzip, unzstd)");
    format = "rosbag2 sqlite3";
    return std::make_unique<detail::Rosbag2Reader>(source->file());
  }
  return nullptr;
}

/// "drive_10.db3" after "drive_9.db3".
bool natural_less(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::string text_of_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder written by rosbag2: the files that its metadata.yaml names are parts of one bag.
std::unique_ptr<Recording> open_folder(const std::string& folder) {
  std::vector<std::string> files;
  const std::string metadata = text_of_file(folder + "/metadata.yaml");
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    for (const char* part : {".mcap", ".db3"})
      if (name.find(part) != std::string::npos && name.find("-wal") == std::string::npos &&
          name.find("-shm") == std::string::npos &&
          (metadata.empty() || metadata.find(name) != std::string::npos))
        files.push_back(entry->path().string());
  }
  std::sort(files.begin(), files.end(), natural_less);
  detail::BagRecording::Parts parts;
  std::string format;
  for (const std::string& file : files) {
    auto source = std::make_unique<ByteSource>(file);
    if (auto reader = open_bag(source, format)) parts.push_back(std::move(reader));
  }
  if (parts.empty())
    throw error_at(folder, 0, "", "is a folder without .mcap or .db3 files: expected a bag of rosbag2");
  return std::make_unique<detail::BagRecording>(folder, format, std::move(parts));
}

}  // namespace

std::vector<std::string> unused_by_messages(const ReadOptions& options) {
  std::vector<std::string> unused;
  if (!options.times_file.empty()) unused.emplace_back("--times is not used: messages have their times");
  if (!options.columns.empty()) unused.emplace_back("--columns is not used: messages name their fields");
  if (options.rate > 0) unused.emplace_back("--rate is not used: messages have their times");
  return unused;
}

std::unique_ptr<Recording> open_recording(const std::string& file, const ReadOptions& options) {
  std::error_code none;
  if (fs::is_directory(file, none)) return open_folder(file);
  auto source = std::make_unique<ByteSource>(file);
  std::string format;
  if (auto reader = open_bag(source, format)) {
    detail::BagRecording::Parts parts;
    parts.push_back(std::move(reader));
    return std::make_unique<detail::BagRecording>(file, format, std::move(parts));
  }
  if (begins_with(*source, detail::colmap_magic))
    return std::make_unique<detail::ColmapImages>(std::move(source), options);
  return std::make_unique<detail::TextRecording>(std::move(source), options);
}

RecordingName parse_recording_name(const std::string& text) {
  std::error_code none;
  if (fs::exists(text, none)) return {text, ""};
  for (std::size_t colon = text.find(':'); colon != std::string::npos; colon = text.find(':', colon + 1))
    if (fs::exists(text.substr(0, colon), none)) return {text.substr(0, colon), text.substr(colon + 1)};
  return {text, ""};
}

}  // namespace egocal
