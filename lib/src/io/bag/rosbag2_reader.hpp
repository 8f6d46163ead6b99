// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "io/bag/message_reader.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace egocal::detail {

inline constexpr std::string_view sqlite_magic{"SQLite format 3\0", 16};

/// The messages of a rosbag2 database (.db3). The file is opened for reading only and nothing is written
/// beside it. Rows that cannot be read are stepped over.
class Rosbag2Reader : public MessageReader {
 public:
  /// Throws Error where the file is no database, or has no tables of rosbag2.
  explicit Rosbag2Reader(const std::string& file) : Rosbag2Reader(file, file, {}) {}
  /// Reads a packed file, which is unpacked into a copy first. The copy is removed before this returns.
  static std::unique_ptr<Rosbag2Reader> unpacked(ByteSource& source);

  bool next(BagMessage& message) override;
  void rewind() override;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;
  /// file: the name in messages; losses: those of the database as a whole.
  Rosbag2Reader(std::string file, const std::string& database, ReadLosses losses);
  void allow_a_missing_end(const std::string& database);
  Statement prepare(const char* sql) const;
  void read_topics();
  bool step_over_damage();
  void look_behind(std::int64_t id);

  std::string file_;
  ReadLosses of_file_;  ///< what is known before a row is read
  std::unique_ptr<sqlite3, Close> database_;
  Statement messages_;
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::int64_t last_id_ = 0, largest_id_ = 0;  ///< of messages; the rows are read in the order of their ids
};

}  // namespace egocal::detail
