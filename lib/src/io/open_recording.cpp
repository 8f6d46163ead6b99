// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <string_view>

#include "egocal/error.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/printable.hpp"
#include "io/bag/bag_folder.hpp"
#include "io/bag/bag_recording.hpp"
#include "io/bag/mcap_reader.hpp"
#include "io/bag/rosbag1_reader.hpp"
#include "io/bag/rosbag2_reader.hpp"
#include "io/stream_list.hpp"
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
  for (const char* old : {"#ROSBAG", "#ROSRECORD", "#ROSLOG"})
    if (begins_with(*source, old))
      throw error_at(
          source->file(), 0, "",
          "is a ROS bag of an old format, before 2.0; migrate it with `rosbag fix OLD NEW` of ROS 1");
  if (begins_with(*source, detail::sqlite_magic)) {
    format = "rosbag2 sqlite3";
    // packed, or a pipe
    if (source->plain_size() == 0) return detail::Rosbag2Reader::unpacked(*source);
    return std::make_unique<detail::Rosbag2Reader>(source->file());
  }
  return nullptr;
}

std::string in_words_of_strangers(const std::vector<std::string>& names) {
  const std::string first = printable(names.front());
  if (names.size() == 1) return first + " is in the folder and not in metadata.yaml: it is not read";
  return std::to_string(names.size()) +
         " bags in the folder are not in metadata.yaml and are not read (first: " + first + ")";
}

/// A folder written by rosbag2: the files that its metadata.yaml names are parts of one bag.
std::unique_ptr<Recording> open_folder(const std::string& folder) {
  const detail::BagFolder bag = detail::look_into(folder);
  detail::BagRecording::Parts readers;
  detail::KnownOfBag known;
  std::string format;
  for (const detail::BagFolder::Part& part : bag.parts) {
    std::string problem = printable(part.name) + ": is named by metadata.yaml and not there";
    if (!part.path.empty()) try {
        auto source = std::make_unique<ByteSource>(part.path);
        problem = part.path + (source->peek(1).empty() ? ": is empty" : ": does not begin like a bag");
        if (auto reader = open_bag(source, format)) {
          readers.push_back(std::move(reader));
          continue;
        }
      } catch (const Error& error) {
        problem = error.what();
      }
    if (known.losses.parts++ == 0) known.losses.first_part = problem;
  }
  if (bag.parts.empty())
    throw error_at(folder, 0, "", "is a folder without .mcap or .db3 files: expected a bag of rosbag2");
  if (readers.empty()) throw error_at(folder, 0, "", losses_in_words(known.losses));
  if (!bag.strangers.empty()) known.notes.push_back(in_words_of_strangers(bag.strangers));
  return std::make_unique<detail::BagRecording>(folder, format, std::move(readers), std::move(known));
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
  if (detail::is_bag_metadata(file)) {
    const fs::path folder = fs::path(file).parent_path();
    return open_folder(folder.empty() ? "." : folder.string());
  }
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
