// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "egocal/io/recording.hpp"
#include "egocal/io/twist_integrator.hpp"
#include "io/bag/frame_counts.hpp"
#include "io/bag/message_reader.hpp"
#include "io/bag/packed_message.hpp"
#include "io/bag/pose_messages.hpp"

namespace egocal::detail {

/// What is known of a bag before it is read.
struct KnownOfBag {
  ReadLosses losses{};  ///< parts that are missing
  std::vector<std::string> notes{};
};

/// The poses of a bag: one stream a topic, and one a transform for tf topics. Several files are parts of one
/// bag, in order.
class BagRecording : public Recording {
 public:
  using Parts = std::vector<std::unique_ptr<MessageReader>>;
  BagRecording(std::string file, std::string format, Parts parts, KnownOfBag known = {})
      : Recording(std::move(file)),
        format_(std::move(format)),
        parts_(std::move(parts)),
        known_(std::move(known)) {}

  std::string format() const override { return format_; }
  void read(const std::string& topic, const TakePose& take) override;

 private:
  void read_part(MessageReader& part, const std::string& topic, const TakePose& take);
  std::size_t stream_of(const BagTopic& topic);
  std::size_t transform_stream(const BagTopic& topic, const MessagePose& pose);
  void take_message(MessageReader& part, const BagMessage& message, std::size_t stream, const TakePose& take);

  /// A pose that may be used.
  struct Usable {
    DualQuaternion pose;
    bool velocity = false;  ///< only the two below are known
    Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
    std::int64_t stamp_ns = 0;  ///< of the header; 0: none
    std::int64_t log_time_ns = 0;
  };
  void take_usable(const Usable& usable, std::size_t stream, const TakePose& take);
  void take_at(std::int64_t time_ns, const Usable& usable, std::size_t stream, const TakePose& take);
  static bool begins_at_zero(const Usable& first, const Usable& second);
  void take_undecided(std::size_t stream, const TakePose& take);
  void refuse(const std::string& topic, const std::string& reason);

  /// Whether messages of a stream have a time in their header. The first one that has, or most_undecided that
  /// have none, decide.
  struct Stamps {
    enum class Decision { open, stamped, unstamped } decision = Decision::open;
    std::vector<Usable> undecided{};  ///< the first messages, which have none
  };
  static constexpr std::size_t most_undecided = 1000;  ///< limit on memory: 200 kB a stream

  std::string format_;
  Parts parts_;
  KnownOfBag known_;
  bool read_before_ = false;
  std::map<std::pair<std::string, std::string>, std::size_t> topics_;      ///< stream by topic and type
  std::map<std::pair<std::size_t, std::string>, std::size_t> transforms_;  ///< by stream of the topic, frames
  std::map<std::size_t, TwistIntegrator> integrators_;                     ///< by stream
  std::vector<Stamps> stamps_;                                             ///< by stream
  std::vector<FrameCounts> frames_;  ///< by stream, of topics that are not split by frames
  PackedMessage unpacker_;
  std::uint64_t unstamped_ = 0;
};

}  // namespace egocal::detail
