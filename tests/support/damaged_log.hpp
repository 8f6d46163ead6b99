// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/random_motion.hpp"

namespace egocal::test {

constexpr std::size_t log_header_size = 28;

/// A log of two simulated sensors, with a message of changing length now and then, as the bytes of its file.
struct SmallLog {
  std::string bytes;
  std::vector<std::size_t> begin;  ///< of each event; one more: the end
  std::size_t events() const { return begin.size() - 1; }
  /// Which event a byte belongs to.
  std::size_t event_at(std::size_t byte) const {
    return static_cast<std::size_t>(std::upper_bound(begin.begin(), begin.end(), byte) - begin.begin()) - 1;
  }
};

inline std::string read_bytes(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
inline void write_bytes(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline SmallLog small_log(const std::string& file, int poses) {
  SimulationOptions options;
  options.poses = poses;
  options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
  const std::vector<Trajectory> trajectories = simulate(options);
  SmallLog log;
  std::size_t size = 0;
  bus::LogWriter writer(file);
  const auto write = [&](std::int64_t time_us, const std::string& channel,
                         const std::vector<std::byte>& data) {
    writer.write(time_us, channel, data);
    log.begin.push_back(size);
    size += log_header_size + channel.size() + data.size();
  };
  for (int i = 0; i < poses; ++i) {
    const auto k = static_cast<std::size_t>(i);
    StampedPose left = trajectories[0][k], right = trajectories[1][k];
    left.time_us += 1'600'000'000'000'000;
    right.time_us += 1'600'000'000'000'000;
    write(left.time_us, "ODOMETRY_LEFT", bus::encode(bus::to_message(left, i)));
    write(right.time_us, "ODOMETRY_RIGHT_2", bus::encode(bus::to_pose_message(right)));
    if (i % 5 != 4) continue;
    status_t status{};
    status.last_error = std::string(k, 'x');
    write(right.time_us, "EGOCAL_STATUS", bus::encode(status));
  }
  writer.close();
  log.begin.push_back(size);
  log.bytes = read_bytes(file);
  return log;
}

/// A log after an accident, and what is still whole in it.
struct DamagedLog {
  std::string bytes;
  struct Whole {
    std::size_t event;  ///< of the original
    std::size_t at;     ///< where it begins now
  };
  std::vector<Whole> whole;
  bool shifted = false;  ///< bytes are missing or elsewhere
};

/// A damaged log: pieces of the original in this order, with some bytes changed (places in the result).
class Accident {
 public:
  explicit Accident(const SmallLog& log) : log_(log) {}

  void piece(std::size_t from, std::size_t to) {
    if (from < to) pieces_.push_back({from, to, bytes_.size()});
    bytes_ += log_.bytes.substr(from, to - from);
  }
  std::size_t size() const { return bytes_.size(); }
  void flip(std::size_t at, int bit) { touch(at, static_cast<char>(bytes_[at] ^ (1 << bit))); }
  void put(std::size_t at, char value) {
    if (bytes_[at] != value) touch(at, value);
  }

  DamagedLog happened() const {
    DamagedLog result{bytes_, {}, pieces_.size() != 1 || pieces_[0].from != 0};
    for (const Piece& piece : pieces_)
      for (std::size_t i = 0; i < log_.events(); ++i) {
        if (log_.begin[i] < piece.from || log_.begin[i + 1] > piece.to) continue;
        const std::size_t at = piece.at + log_.begin[i] - piece.from;
        const std::size_t end = at + log_.begin[i + 1] - log_.begin[i];
        if (std::none_of(touched_.begin(), touched_.end(), [&](std::size_t t) { return t >= at && t < end; }))
          result.whole.push_back({i, at});
      }
    std::sort(result.whole.begin(), result.whole.end(),
              [](const auto& x, const auto& y) { return x.at < y.at; });
    return result;
  }

 private:
  struct Piece {
    std::size_t from, to, at;
  };
  void touch(std::size_t at, char value) {
    bytes_[at] = value;
    touched_.push_back(at);
  }
  const SmallLog& log_;
  std::string bytes_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> touched_;
};

enum class Damage { cut, bits, zeros, noise, swapped, missing, lengths };
constexpr Damage all_damages[] = {Damage::cut,     Damage::bits,    Damage::zeros,  Damage::noise,
                                  Damage::swapped, Damage::missing, Damage::lengths};

inline DamagedLog damaged(const SmallLog& log, Damage damage, testing::Random& random) {
  const std::size_t size = log.bytes.size();
  Accident accident(log);
  switch (damage) {
    case Damage::cut:
      accident.piece(0, 1 + random.below(size - 1));
      break;
    case Damage::bits: {
      accident.piece(0, size);
      const std::uint64_t flips = 1 + random.below(20);
      for (std::uint64_t i = 0; i < flips; ++i) {
        const int bit = static_cast<int>(random.below(8));
        accident.flip(random.below(size), bit);
      }
      break;
    }
    case Damage::zeros:
    case Damage::noise: {
      accident.piece(0, size);
      const std::size_t from = random.below(size), to = std::min(size, from + 1 + random.below(1500));
      for (std::size_t i = from; i < to; ++i)
        accident.put(i, damage == Damage::zeros ? '\0' : static_cast<char>(random.bits()));
      break;
    }
    case Damage::swapped: {
      std::size_t at[4];
      for (std::size_t& place : at) place = random.below(size + 1);
      std::sort(at, at + 4);
      accident.piece(0, at[0]);
      accident.piece(at[2], at[3]);
      accident.piece(at[1], at[2]);
      accident.piece(at[0], at[1]);
      accident.piece(at[3], size);
      break;
    }
    case Damage::missing: {
      const std::size_t from = random.below(size), to = std::min(size, from + 1 + random.below(1500));
      accident.piece(0, from);
      accident.piece(to, size);
      break;
    }
    case Damage::lengths: {
      accident.piece(0, size);
      const std::uint32_t lies[] = {0xffffffff, 0x80000000, 0x7fffffff, 0, 1, 63, 64, 128, 1 << 20, 64 << 20};
      const std::uint64_t count = 1 + random.below(4);
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::size_t event = random.below(log.events());
        const std::size_t field = log.begin[event] + (random.below(2) ? 20 : 24);
        const std::uint32_t lie = lies[random.below(std::size(lies))];
        for (std::size_t k = 0; k < 4; ++k) accident.put(field + k, static_cast<char>(lie >> (24 - 8 * k)));
      }
      break;
    }
  }
  return accident.happened();
}

}  // namespace egocal::test
