// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Every file of the MCAP project's conformance suite, record by record against its description.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "../support/paths.hpp"
#include "../support/scratch_folder.hpp"
#include "io/bag/mcap_records.hpp"
#include "io/bytes/little_endian.hpp"

namespace egocal::detail::test_io_mcap_conformance {
namespace {

using nlohmann::json;

json bytes_of(ByteSpan bytes) {
  json list = json::array();
  for (const unsigned char byte : bytes) list.push_back(std::to_string(byte));
  return list;
}

template <class Number>
std::string decimal(Number number) {
  return std::to_string(number);
}

/// A map: the length of all, then keys and values.
template <class Value>
json map_of(LittleEndian& from, Value value) {
  LittleEndian entries(from.take(from.u32()));
  json object = json::object();
  while (entries.ok() && entries.left() > 0) value(entries, object);
  return object;
}

json texts_of(LittleEndian& from) {
  return map_of(from, [](LittleEndian& entry, json& object) {
    const std::string key(entry.text());
    object[key] = std::string(entry.text());
  });
}

json counts_of(LittleEndian& from) {
  return map_of(from, [](LittleEndian& entry, json& object) {
    const std::string key = decimal(entry.u16());
    object[key] = decimal(entry.u64());
  });
}

/// The record as the suite describes it: type, and fields by name. Empty for records it does not list.
json described(const McapRecord& record) {
  LittleEndian from(record.content);
  const auto u16 = [&] { return json(decimal(from.u16())); };
  const auto u32 = [&] { return json(decimal(from.u32())); };
  const auto u64 = [&] { return json(decimal(from.u64())); };
  const auto text = [&] { return json(std::string(from.text())); };
  json f = json::object();
  std::string type;
  const auto take = [&](const char* name, json value) { f[name] = std::move(value); };
  switch (record.opcode) {
    case 0x01:
      type = "Header";
      take("profile", text());
      take("library", text());
      break;
    case 0x02:
      type = "Footer";
      take("summary_start", u64());
      take("summary_offset_start", u64());
      take("summary_crc", u32());
      break;
    case 0x03:
      type = "Schema";
      take("id", u16());
      take("name", text());
      take("encoding", text());
      take("data", bytes_of(from.take(from.u32())));
      break;
    case 0x04:
      type = "Channel";
      take("id", u16());
      take("schema_id", u16());
      take("topic", text());
      take("message_encoding", text());
      take("metadata", texts_of(from));
      break;
    case 0x05:
      type = "Message";
      take("channel_id", u16());
      take("sequence", u32());
      take("log_time", u64());
      take("publish_time", u64());
      take("data", bytes_of(from.take(from.left())));
      break;
    case 0x08:
      type = "ChunkIndex";
      take("message_start_time", u64());
      take("message_end_time", u64());
      take("chunk_start_offset", u64());
      take("chunk_length", u64());
      take("message_index_offsets", counts_of(from));
      take("message_index_length", u64());
      take("compression", text());
      take("compressed_size", u64());
      take("uncompressed_size", u64());
      break;
    case 0x09:
      type = "Attachment";
      take("log_time", u64());
      take("create_time", u64());
      take("name", text());
      take("media_type", text());
      take("data", bytes_of(from.take(from.u64())));
      break;
    case 0x0a:
      type = "AttachmentIndex";
      take("offset", u64());
      take("length", u64());
      take("log_time", u64());
      take("create_time", u64());
      take("data_size", u64());
      take("name", text());
      take("media_type", text());
      break;
    case 0x0b:
      type = "Statistics";
      take("message_count", u64());
      take("schema_count", u16());
      take("channel_count", u32());
      take("attachment_count", u32());
      take("metadata_count", u32());
      take("chunk_count", u32());
      take("message_start_time", u64());
      take("message_end_time", u64());
      take("channel_message_counts", counts_of(from));
      break;
    case 0x0c:
      type = "Metadata";
      take("name", text());
      take("metadata", texts_of(from));
      break;
    case 0x0d:
      type = "MetadataIndex";
      take("offset", u64());
      take("length", u64());
      take("name", text());
      break;
    case 0x0e:
      type = "SummaryOffset";
      take("group_opcode", json(decimal(from.u8())));
      take("group_start", u64());
      take("group_length", u64());
      break;
    case 0x0f:
      type = "DataEnd";
      take("data_section_crc", u32());
      break;
    default:
      return {};
  }
  EXPECT_TRUE(from.ok()) << type;
  return {{"type", type}, {"fields", f}};
}

/// A download without git-lfs has pointers in place of the files; those are then made from their descriptions
/// and checked against the pointers' SHA-256.
bool is_pointer(const std::filesystem::path& file) {
  std::string line;
  std::ifstream stream(file, std::ios::binary);
  return std::getline(stream, line) && line.rfind("version https://git-lfs", 0) == 0;
}

TEST(McapConformance, EveryFileIsReadAsDescribed) {
  const std::filesystem::path folder = paths::data_dir() + "/mcap_conformance";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared/data/mcap_conformance is not there";
  const egocal::testing::ScratchFolder made;
  std::filesystem::path files_folder = folder;
  bool pointers = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    pointers = pointers || (entry.path().extension() == ".mcap" && is_pointer(entry.path()));
  if (pointers) {
    files_folder = made.path("");
    const std::string command = paths::source_dir() + "/tests/support/mcap_from_descriptions " +
                                folder.string() + " " + files_folder.string();
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(files_folder)) {
    if (entry.path().extension() != ".mcap") continue;
    ++files;
    json expected;
    std::ifstream((folder / entry.path().filename()).replace_extension(".json")) >> expected;
    McapRecords records(std::make_unique<ByteSource>(entry.path().string()));
    std::vector<json> read;
    for (McapRecord record; records.next(record);)
      if (json found = described(record); !found.empty()) read.push_back(std::move(found));
    ASSERT_EQ(read.size(), expected["records"].size()) << entry.path();
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i]["type"], expected["records"][i]["type"]) << entry.path();
      for (const json& field : expected["records"][i]["fields"])
        EXPECT_EQ(read[i]["fields"][field[0].get<std::string>()], field[1])
            << entry.path() << " record " << i;
    }
    EXPECT_FALSE(records.losses().any()) << entry.path() << losses_in_words(records.losses());
  }
  EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace egocal::detail::test_io_mcap_conformance
