// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "io/bag/mcap_records.hpp"

namespace egocal {

namespace {

constexpr std::size_t chunk_size = 1 << 20;  // [bytes], as rosbag2 and Foxglove write them
constexpr std::size_t most_channels =
    std::numeric_limits<std::uint16_t>::max();  // by the format, with ids from 1

const std::string pose_type = "geometry_msgs/msg/PoseStamped";
const std::string transform_type = "tf2_msgs/msg/TFMessage";
const std::string header_definition =
    "================================================================================\nMSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
const std::string pose_definition = "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + header_definition +
                                    "========================================================================"
                                    "========\nMSG: geometry_msgs/Pose\n"
                                    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
                                    "========================================================================"
                                    "========\nMSG: geometry_msgs/Point\n"
                                    "float64 x\nfloat64 y\nfloat64 z\n";
const std::string transform_definition =
    "geometry_msgs/TransformStamped[] transforms\n"
    "================================================================================\n"
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
    "geometry_msgs/Transform transform\n" +
    header_definition +
    "================================================================================\n"
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
    "================================================================================\nMSG: "
    "geometry_msgs/Vector3\n"
    "float64 x\nfloat64 y\nfloat64 z\n";

/// Appends little-endian numbers and texts with their length.
class Bytes {
 public:
  Bytes& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
    return *this;
  }
  Bytes& text(const std::string& value) {
    number(value.size(), 4);
    bytes += value;
    return *this;
  }
  std::string bytes;
};

/// A message in CDR, little-endian.
class Cdr {
 public:
  Cdr& u32(std::uint32_t value) { return number(value, 4); }
  Cdr& f64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
  Cdr& text(const std::string& value) {
    u32(static_cast<std::uint32_t>(value.size() + 1));
    body_.bytes += value + '\0';
    return *this;
  }
  Cdr& header(std::int64_t time_us, const std::string& frame) {
    const std::int64_t seconds = time_us >= 0 ? time_us / 1'000'000 : (time_us - 999'999) / 1'000'000;
    u32(static_cast<std::uint32_t>(seconds));
    u32(static_cast<std::uint32_t>((time_us - seconds * 1'000'000) * 1000));
    return text(frame);
  }
  Cdr& pose(const DualQuaternion& q) {
    const Pose T = to_pose(q);
    for (int i = 0; i < 3; ++i) f64(T.translation[i]);
    return f64(T.rotation.x()).f64(T.rotation.y()).f64(T.rotation.z()).f64(T.rotation.w());
  }
  std::string done() const { return std::string("\0\1\0\0", 4) + body_.bytes; }

 private:
  Cdr& number(std::uint64_t value, int size) {
    while (body_.bytes.size() % static_cast<std::size_t>(size) != 0) body_.bytes += '\0';
    body_.number(value, size);
    return *this;
  }
  Bytes body_;
};

std::uint32_t crc_of(const std::string& bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string record(int opcode, const std::string& content) {
  return Bytes().number(static_cast<std::uint64_t>(opcode), 1).number(content.size(), 8).bytes + content;
}

}  // namespace

struct McapWriter::State {
  struct Channel {
    std::uint16_t id = 0;
    std::uint64_t messages = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  ///< time and offset, of the open chunk
  };

  explicit State(const std::string& name) : file(name), out(name) {}

  std::string file;
  WholeFile out;
  std::uint64_t offset = 0;
  std::uint32_t crc = 0;
  std::map<std::string, Channel> channels;  ///< by topic
  std::string announcements;                ///< schemas and channels, for the summary
  std::string chunk;
  std::uint64_t chunk_first = UINT64_MAX, chunk_last = 0, first = UINT64_MAX, last = 0, messages = 0;
  std::string chunk_indexes;
  std::uint32_t chunks = 0, schemas = 0;

  void write(const std::string& bytes) {
    out.write(bytes);
    offset += bytes.size();
    crc = crc_of(bytes, crc);
  }

  Channel& channel(const std::string& topic, const std::string& type, const std::string& definition) {
    const auto known = channels.find(topic);
    if (known != channels.end()) return known->second;
    if (channels.size() == most_channels)
      throw error_at(file, 0, "",
                     "an MCAP file holds at most " + std::to_string(most_channels) + " channels, and \"" +
                         topic + "\" is one more");
    Channel& added = channels[topic];
    added.id = static_cast<std::uint16_t>(channels.size());
    ++schemas;
    const std::string text =
        record(3, Bytes().number(added.id, 2).text(type).text("ros2msg").text(definition).bytes) +
        record(4, Bytes().number(added.id, 2).number(added.id, 2).text(topic).text("cdr").number(0, 4).bytes);
    announcements += text;
    chunk += text;
    return added;
  }

  void message(Channel& to, std::int64_t time_us, const std::string& data) {
    const std::uint64_t time = time_us > 0 ? static_cast<std::uint64_t>(time_us) * 1000 : 0;
    to.index.emplace_back(time, chunk.size());
    chunk += record(
        5, Bytes().number(to.id, 2).number(to.messages++, 4).number(time, 8).number(time, 8).bytes + data);
    chunk_first = std::min(chunk_first, time);
    chunk_last = std::max(chunk_last, time);
    ++messages;
    if (chunk.size() >= chunk_size) flush();
  }

  void flush() {
    if (chunk.empty()) return;
    std::string packed(ZSTD_compressBound(chunk.size()), '\0');
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), chunk.data(), chunk.size(), 1);
    if (ZSTD_isError(size)) throw error_at(file, 0, "", "cannot be packed");
    packed.resize(size);
    const std::uint64_t start = offset;
    if (chunk_first == UINT64_MAX) chunk_first = 0;
    write(record(6, Bytes().number(chunk_first, 8)
                            .number(chunk_last, 8)
                            .number(chunk.size(), 8)
                            .number(crc_of(chunk), 4)
                            .text("zstd")
                            .number(packed.size(), 8)
                            .bytes +
                        packed));
    const std::uint64_t chunk_length = offset - start;
    Bytes offsets;
    for (auto& [topic, channel] : channels) {
      if (channel.index.empty()) continue;
      Bytes entries;
      std::stable_sort(channel.index.begin(), channel.index.end());
      for (const auto& [time, at] : channel.index) entries.number(time, 8).number(at, 8);
      channel.index.clear();
      offsets.number(channel.id, 2).number(offset, 8);
      write(record(7, Bytes().number(channel.id, 2).text(entries.bytes).bytes));
    }
    chunk_indexes += record(8, Bytes()
                                   .number(chunk_first, 8)
                                   .number(chunk_last, 8)
                                   .number(start, 8)
                                   .number(chunk_length, 8)
                                   .text(offsets.bytes)
                                   .number(offset - start - chunk_length, 8)
                                   .text("zstd")
                                   .number(packed.size(), 8)
                                   .number(chunk.size(), 8)
                                   .bytes);
    ++chunks;
    first = std::min(first, chunk_first);
    last = std::max(last, chunk_last);
    chunk_first = UINT64_MAX;
    chunk_last = 0;
    chunk.clear();
  }

  void finish() {
    flush();
    write(record(15, Bytes().number(crc, 4).bytes));
    const std::uint64_t summary = offset;
    Bytes counts;
    for (const auto& [topic, channel] : channels) counts.number(channel.id, 2).number(channel.messages, 8);
    const std::string text = announcements +
                             record(11, Bytes()
                                            .number(messages, 8)
                                            .number(schemas, 2)
                                            .number(channels.size(), 4)
                                            .number(0, 4)
                                            .number(0, 4)
                                            .number(chunks, 4)
                                            .number(messages > 0 ? first : 0, 8)
                                            .number(last, 8)
                                            .text(counts.bytes)
                                            .bytes) +
                             chunk_indexes;
    write(text);
    // the checksum of the summary covers the footer up to itself
    const std::string footer = Bytes().number(2, 1).number(20, 8).number(summary, 8).number(0, 8).bytes;
    write(footer + Bytes().number(crc_of(text + footer), 4).bytes + std::string(detail::mcap_magic));
  }
};

McapWriter::McapWriter(const std::string& file) : state_(std::make_unique<State>(file)) {
  state_->write(std::string(detail::mcap_magic) + record(1, Bytes().text("ros2").text("egocal").bytes));
}

McapWriter::~McapWriter() = default;

void McapWriter::write_pose(const std::string& topic, const std::string& frame, const StampedPose& pose) {
  State::Channel& channel = state_->channel(topic, pose_type, pose_definition);
  state_->message(channel, pose.time_us, Cdr().header(pose.time_us, frame).pose(pose.pose).done());
}

void McapWriter::write_transform(const std::string& parent, const std::string& child,
                                 const StampedPose& pose) {
  State::Channel& channel = state_->channel("/tf", transform_type, transform_definition);
  state_->message(channel, pose.time_us,
                  Cdr().u32(1).header(pose.time_us, parent).text(child).pose(pose.pose).done());
}

void McapWriter::close() {
  state_->finish();
  state_->out.commit();
}

}  // namespace egocal
