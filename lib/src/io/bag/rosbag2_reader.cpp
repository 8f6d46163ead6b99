// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/rosbag2_reader.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "egocal/error.hpp"
#include "io/bag/scratch_file.hpp"

namespace egocal::detail {

namespace {

/// A file name as part of a URI.
std::string uri_of(const std::string& file) {
  std::string uri = "file:";
  constexpr const char* digits = "0123456789abcdef";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#' || code < 0x20 || code > 0x7e)
      uri += {'%', digits[code >> 4], digits[code & 15]};
    else
      uri += c;
  }
  // a recorder that was killed leaves its newest rows in a -wal file; without one nothing needs a lock
  std::error_code none;
  return uri + (std::filesystem::exists(file + "-wal", none) ? "?mode=ro" : "?mode=ro&immutable=1");
}

std::string text_of(sqlite3_stmt* statement, int column) {
  const unsigned char* text = sqlite3_column_text(statement, column);
  return text ? std::string(reinterpret_cast<const char*>(text),
                            static_cast<std::size_t>(sqlite3_column_bytes(statement, column)))
              : std::string();
}

/// Bytes that the file's header promises and the file does not have.
std::uint64_t missing_bytes(const std::string& file) {
  unsigned char header[100] = {};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(header), sizeof header)) return 0;
  const auto number = [&](std::size_t at, std::size_t size) {  // big-endian
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + size; ++i) value = value << 8 | header[i];
    return value;
  };
  // the number of pages counts where the change that wrote it is the last one
  if (number(24, 4) != number(92, 4)) return 0;
  const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2);
  std::error_code none;
  const std::uintmax_t there = std::filesystem::file_size(file, none);
  const std::uint64_t promised = page * number(28, 4);
  return !none && there < promised ? promised - there : 0;
}

}  // namespace

void Rosbag2Reader::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}
void Rosbag2Reader::Close::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

std::unique_ptr<Rosbag2Reader> Rosbag2Reader::unpacked(ByteSource& source) {
  const ScratchFile scratch(source);
  // an open file is read on when its name is gone
  return std::unique_ptr<Rosbag2Reader>(new Rosbag2Reader(source.file(), scratch.path(), scratch.losses()));
}

Rosbag2Reader::Rosbag2Reader(std::string file, const std::string& path, ReadLosses losses)
    : file_(std::move(file)), of_file_(std::move(losses)) {
  sqlite3* database = nullptr;
  const int result = sqlite3_open_v2(uri_of(path).c_str(), &database,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (result != SQLITE_OK) throw error_at(file_, 0, "", "cannot be opened as a rosbag2 database");
  // what a hostile or damaged database may ask for is bounded
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(largest_record));
  sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_exec(database, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0; PRAGMA cache_size=-4096", nullptr,
               nullptr, nullptr);
  allow_a_missing_end(path);
  for (const char* table : {"topics", "messages"}) {
    const Statement look = prepare(
        "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?1 AND sql NOT LIKE '%VIRTUAL%'");
    sqlite3_bind_text(look.get(), 1, table, -1, SQLITE_STATIC);
    const int found = sqlite3_step(look.get());
    if (found == SQLITE_ROW) continue;
    if (found == SQLITE_DONE)
      throw error_at(
          file_, 0, "",
          std::string("is an SQLite database without the table '") + table + "': expected a bag of rosbag2");
    throw error_at(file_, 0, "",
                   std::string("cannot be read as a rosbag2 database: ") + sqlite3_errmsg(database_.get()));
  }
  rewind();
}

/// SQLite refuses every query of a file that is shorter than its header says, unless the schema may be
/// written. Here nothing can be: the file is open for reading only.
void Rosbag2Reader::allow_a_missing_end(const std::string& path) {
  const std::uint64_t missing = missing_bytes(path);
  if (missing == 0) return;
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  of_file_.truncated = true;
  of_file_.bytes += missing;
}

Rosbag2Reader::Statement Rosbag2Reader::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK)
    throw error_at(file_, 0, "",
                   std::string("cannot be read as a rosbag2 database: ") + sqlite3_errmsg(database_.get()));
  return Statement(statement);
}

void Rosbag2Reader::rewind() {
  losses_ = of_file_;
  read_topics();
  const Statement most = prepare("SELECT max(rowid) FROM messages");
  // the last row may be the one that cannot be read
  largest_id_ = sqlite3_step(most.get()) == SQLITE_ROW
                    ? std::max<std::int64_t>(0, sqlite3_column_int64(most.get(), 0))
                    : std::numeric_limits<std::int64_t>::max();
  last_id_ = std::numeric_limits<std::int64_t>::min();
  messages_ =
      prepare("SELECT rowid, topic_id, timestamp, data FROM messages WHERE rowid > ?1 ORDER BY rowid");
  sqlite3_bind_int64(messages_.get(), 1, last_id_);
}

void Rosbag2Reader::read_topics() {
  topics_.clear();
  topic_of_id_.clear();
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    topic_of_id_[sqlite3_column_int64(rows.get(), 0)] = topics_.size();
    topics_.push_back(
        {text_of(rows.get(), 1), ros1_type_name(text_of(rows.get(), 2)), text_of(rows.get(), 3)});
  }
  if (result != SQLITE_DONE) ++losses_.regions;
}

bool Rosbag2Reader::next(BagMessage& message) {
  while (true) {
    const int result = sqlite3_step(messages_.get());
    if (result == SQLITE_DONE) return false;
    if (result != SQLITE_ROW) {
      if (!step_over_damage()) return false;
      continue;
    }
    const std::int64_t id = sqlite3_column_int64(messages_.get(), 0);
    if (id <= last_id_) {  // damaged pages that lead in a circle
      if (!step_over_damage()) return false;
      continue;
    }
    last_id_ = id;
    const auto topic = topic_of_id_.find(sqlite3_column_int64(messages_.get(), 1));
    if (topic == topic_of_id_.end() || sqlite3_column_type(messages_.get(), 3) != SQLITE_BLOB) {
      ++losses_.regions;
      continue;
    }
    message.topic = topic->second;
    message.log_time_ns = sqlite3_column_int64(messages_.get(), 2);
    const void* const data = sqlite3_column_blob(messages_.get(), 3);
    const int size = sqlite3_column_bytes(messages_.get(), 3);
    message.data = {static_cast<const unsigned char*>(data), data ? static_cast<std::size_t>(size) : 0};
    return true;
  }
}

void Rosbag2Reader::look_behind(std::int64_t id) {
  sqlite3_reset(messages_.get());
  sqlite3_bind_int64(messages_.get(), 1, id);
}

/// Continues at the first readable row after an unreadable one: looks farther and farther ahead, then
/// bisects. At most about 130 looks, as a damaged file may name any number as a row.
bool Rosbag2Reader::step_over_damage() {
  ++losses_.regions;
  const auto readable = [&](std::int64_t id) {
    look_behind(id);
    return sqlite3_step(messages_.get()) == SQLITE_ROW && sqlite3_column_int64(messages_.get(), 0) > id;
  };
  std::int64_t damaged = std::max<std::int64_t>(last_id_, 0), sound = 0, stride = 1;
  while (true) {
    if (damaged >= largest_id_) return false;
    sound = damaged + std::min(stride, largest_id_ - damaged);
    if (readable(sound)) break;
    damaged = sound;
    stride = stride > largest_id_ / 2 ? largest_id_ : 2 * stride;
  }
  while (sound - damaged > 1) {
    const std::int64_t middle = std::midpoint(damaged, sound);
    (readable(middle) ? sound : damaged) = middle;
  }
  last_id_ = sound;
  look_behind(sound);
  return true;
}

}  // namespace egocal::detail
