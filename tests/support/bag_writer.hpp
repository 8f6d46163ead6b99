// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

/// Bags as other programs write them, for tests of the readers. Written from the specifications of the
/// formats, not from the readers.
namespace egocal::testing {

inline std::string little(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}
inline std::string with_length(const std::string& text) {
  return little(text.size(), 4) + text;
}

/// Serialises ROS messages: "ros1", or CDR in either byte order.
class MessageEncoder {
 public:
  enum class Kind { ros1, cdr, cdr_big_endian };
  explicit MessageEncoder(Kind kind) : kind_(kind) {}

  MessageEncoder& u32(std::uint32_t value) { return bits(value, 4); }
  MessageEncoder& f64(double value) { return bits(std::bit_cast<std::uint64_t>(value), 8); }
  MessageEncoder& text(const std::string& value) {
    const bool cdr = kind_ != Kind::ros1;
    u32(static_cast<std::uint32_t>(value.size() + (cdr ? 1 : 0)));
    bytes_ += value;
    if (cdr) bytes_ += '\0';
    return *this;
  }
  MessageEncoder& header(std::int64_t time_us, const std::string& frame) {
    if (kind_ == Kind::ros1) u32(7);
    u32(static_cast<std::uint32_t>(time_us / 1'000'000));
    u32(static_cast<std::uint32_t>(time_us % 1'000'000 * 1000));
    return text(frame);
  }
  MessageEncoder& pose(const DualQuaternion& q) {
    const Pose T = to_pose(q);
    for (int i = 0; i < 3; ++i) f64(T.translation[i]);
    return f64(T.rotation.x()).f64(T.rotation.y()).f64(T.rotation.z()).f64(T.rotation.w());
  }
  MessageEncoder& zeros(int count) {
    for (int i = 0; i < count; ++i) f64(0);
    return *this;
  }
  std::string done() const {
    if (kind_ == Kind::ros1) return bytes_;
    return std::string("\0", 1) + (kind_ == Kind::cdr ? '\1' : '\0') + std::string(2, '\0') + bytes_;
  }

 private:
  MessageEncoder& bits(std::uint64_t value, std::size_t size) {
    while (kind_ != Kind::ros1 && bytes_.size() % size != 0) bytes_ += '\0';
    std::string number = little(value, size);
    if (kind_ == Kind::cdr_big_endian) number = {number.rbegin(), number.rend()};
    bytes_ += number;
    return *this;
  }
  Kind kind_;
  std::string bytes_;
};

/// A message of the type named ("nav_msgs/Odometry", ...) with this pose; frames "odom" and "base/link".
inline std::string encoded(MessageEncoder::Kind kind, const std::string& type, const StampedPose& stamped) {
  MessageEncoder to(kind);
  if (type == "tf2_msgs/TFMessage") to.u32(1);
  to.header(stamped.time_us, "odom");
  if (type == "nav_msgs/Odometry" || type == "geometry_msgs/TransformStamped" || type == "tf2_msgs/TFMessage")
    to.text("base/link");
  to.pose(stamped.pose);
  if (type == "nav_msgs/Odometry") to.zeros(36 + 6 + 36);
  if (type == "geometry_msgs/PoseWithCovarianceStamped") to.zeros(36);
  return to.done();
}

struct WrittenMessage {
  std::string topic, type;  ///< ROS 1 style name
  std::int64_t time_us = 0;
  std::string data;
};

inline std::string ros2_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "/msg" + type.substr(slash);
}

inline std::string packed(const std::string& compression, const std::string& plain) {
  std::string out(plain.size() + plain.size() / 50 + 1000, '\0');
  std::size_t size = 0;
  if (compression == "zstd") {
    size = ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1);
  } else if (compression == "lz4") {
    size = LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr);
  } else if (compression == "bz2") {
    auto room = static_cast<unsigned int>(out.size());
    std::string from = plain;
    if (BZ2_bzBuffToBuffCompress(out.data(), &room, from.data(), static_cast<unsigned int>(from.size()), 1, 0,
                                 0) != BZ_OK)
      std::abort();
    size = room;
  } else {
    return plain;
  }
  out.resize(size);
  return out;
}

struct BagOptions {
  std::string compression;              ///< "", "lz4", "zstd"; rosbag 1: "none", "bz2", "lz4"
  std::size_t messages_per_chunk = 50;  ///< 0: no chunks (MCAP)
  bool checksums = true;                ///< MCAP
  std::string message_encoding = "cdr";
};

inline std::string mcap_record(int opcode, const std::string& content) {
  return static_cast<char>(opcode) + little(content.size(), 8) + content;
}

/// An MCAP file without a summary.
inline std::string mcap_file(const std::vector<WrittenMessage>& messages, const BagOptions& options) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string file = magic + mcap_record(1, with_length("ros2") + with_length("test"));
  std::vector<std::pair<std::string, std::string>> channels;
  const auto crc = [](const std::string& bytes) {
    return crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  };
  std::string records;
  std::size_t in_chunk = 0;
  const auto flush = [&] {
    if (records.empty()) return;
    if (options.messages_per_chunk == 0) {
      file += records;
    } else {
      const std::string data = packed(options.compression, records);
      file += mcap_record(6, little(1, 8) + little(2, 8) + little(records.size(), 8) +
                                 little(options.checksums ? crc(records) : 0, 4) +
                                 with_length(options.compression) + little(data.size(), 8) + data);
    }
    records.clear();
    in_chunk = 0;
  };
  for (const WrittenMessage& message : messages) {
    std::size_t id = 0;
    while (id < channels.size() && channels[id] != std::pair(message.topic, message.type)) ++id;
    if (id == channels.size()) {
      channels.emplace_back(message.topic, message.type);
      records += mcap_record(3, little(id + 1, 2) + with_length(ros2_type(message.type)) +
                                    with_length("ros2msg") + with_length(""));
      records += mcap_record(4, little(id, 2) + little(id + 1, 2) + with_length(message.topic) +
                                    with_length(options.message_encoding) + little(0, 4));
    }
    const auto time_ns = static_cast<std::uint64_t>(message.time_us) * 1000;
    records +=
        mcap_record(5, little(id, 2) + little(1, 4) + little(time_ns, 8) + little(time_ns, 8) + message.data);
    if (++in_chunk == options.messages_per_chunk) flush();
  }
  flush();
  file += mcap_record(15, little(options.checksums ? crc(file) : 0, 4));
  file += mcap_record(2, std::string(20, '\0'));
  return file + magic;
}

inline std::string rosbag1_record(const std::vector<std::pair<std::string, std::string>>& fields,
                                  const std::string& data) {
  std::string header;
  for (const auto& [name, value] : fields) header += with_length(name + "=" + value);
  return with_length(header) + with_length(data);
}

/// A ROS 1 bag without an index, as a killed recorder leaves it.
inline std::string rosbag1_file(const std::vector<WrittenMessage>& messages, const BagOptions& options) {
  std::string file = "#ROSBAG V2.0\n";
  file += rosbag1_record({{"op", "\3"},
                          {"index_pos", little(0, 8)},
                          {"conn_count", little(0, 4)},
                          {"chunk_count", little(0, 4)}},
                         std::string(4000, ' '));
  std::vector<std::pair<std::string, std::string>> connections;
  std::string records;
  std::size_t in_chunk = 0;
  const auto flush = [&] {
    if (records.empty()) return;
    file += rosbag1_record(
        {{"op", "\5"}, {"compression", options.compression}, {"size", little(records.size(), 4)}},
        packed(options.compression, records));
    records.clear();
    in_chunk = 0;
  };
  for (const WrittenMessage& message : messages) {
    std::size_t id = 0;
    while (id < connections.size() && connections[id] != std::pair(message.topic, message.type)) ++id;
    if (id == connections.size()) {
      connections.emplace_back(message.topic, message.type);
      records += rosbag1_record({{"op", "\7"}, {"conn", little(id, 4)}, {"topic", message.topic}},
                                with_length("topic=" + message.topic) + with_length("type=" + message.type) +
                                    with_length("md5sum=*"));
    }
    records += rosbag1_record(
        {{"op", "\2"},
         {"conn", little(id, 4)},
         {"time", little(static_cast<std::uint64_t>(message.time_us / 1'000'000), 4) +
                      little(static_cast<std::uint64_t>(message.time_us % 1'000'000 * 1000), 4)}},
        message.data);
    if (++in_chunk == options.messages_per_chunk) flush();
  }
  flush();
  return file;
}

/// Writes a rosbag2 database of pages of this size [bytes]: small ones make a small file.
inline void write_db3(const std::string& file, const std::vector<WrittenMessage>& messages,
                      int page_size = 4096) {
  std::filesystem::remove(file);
  sqlite3* database = nullptr;
  const auto run = [&](const std::string& sql) {
    if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) std::abort();
  };
  if (sqlite3_open(file.c_str(), &database) != SQLITE_OK) std::abort();
  run("PRAGMA page_size = " + std::to_string(page_size));
  run("BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL); CREATE TABLE messages(id "
      "INTEGER "
      "PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL); CREATE INDEX "
      "timestamp_idx ON messages (timestamp ASC)");
  std::vector<std::pair<std::string, std::string>> topics;
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?1, ?2, ?3)", -1,
                     &insert, nullptr);
  for (const WrittenMessage& message : messages) {
    std::size_t id = 0;
    while (id < topics.size() && topics[id] != std::pair(message.topic, message.type)) ++id;
    if (id == topics.size()) {
      topics.emplace_back(message.topic, message.type);
      run("INSERT INTO topics VALUES(" + std::to_string(id) + ", '" + message.topic + "', '" +
          ros2_type(message.type) + "', 'cdr', '')");
    }
    sqlite3_bind_int64(insert, 1, static_cast<sqlite3_int64>(id));
    sqlite3_bind_int64(insert, 2, message.time_us * 1000);
    sqlite3_bind_blob(insert, 3, message.data.data(), static_cast<int>(message.data.size()), SQLITE_STATIC);
    if (sqlite3_step(insert) != SQLITE_DONE) std::abort();
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run("COMMIT");
  sqlite3_close(database);
}

/// A trajectory as the messages of one topic.
inline std::vector<WrittenMessage> as_messages(const Trajectory& trajectory, const std::string& topic,
                                               const std::string& type, MessageEncoder::Kind kind) {
  std::vector<WrittenMessage> messages;
  for (const StampedPose& pose : trajectory)
    messages.push_back({topic, type, pose.time_us, encoded(kind, type, pose)});
  return messages;
}

}  // namespace egocal::testing
