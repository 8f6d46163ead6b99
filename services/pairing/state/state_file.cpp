// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/state/state_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "egocal/error.hpp"
#include "pairing/state/archive.hpp"

namespace egocal::services {

namespace {

/// The last character tells the byte order of the machine apart.
const std::string magic = [] {
  const std::uint16_t one = 1;
  std::uint8_t low = 0;
  std::memcpy(&low, &one, 1);
  return std::string("egocal-pairing state 1") + (low ? "l" : "b") + "\n";
}();
const std::string magic_of_any_version = "egocal-pairing state ";

/// Before each part: identity, snapshot, additions.
struct PartHeader {
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;         ///< of the part
  std::uint64_t header_checksum = 0;  ///< of the two above
};

PartHeader header_of(std::span<const std::byte> bytes) {
  PartHeader header{bytes.size(), checksum(bytes), 0};
  header.header_checksum = checksum(std::as_bytes(std::span(&header, 1)).first(16));
  return header;
}

std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

void write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error(std::strerror(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void append_part(std::vector<std::byte>& out, std::span<const std::byte> part) {
  const PartHeader header = header_of(part);
  const auto header_bytes = std::as_bytes(std::span(&header, 1));
  out.insert(out.end(), header_bytes.begin(), header_bytes.end());
  out.insert(out.end(), part.begin(), part.end());
}

std::vector<std::byte> whole(int fd) {
  std::vector<std::byte> bytes;
  std::vector<std::byte> buffer(1 << 20);
  for (;;) {
    const ssize_t got = ::read(fd, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(std::strerror(errno));
    if (got == 0) return bytes;
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
  }
}

/// The next part; empty where the bytes end before it does.
std::optional<std::span<const std::byte>> next_part(std::span<const std::byte>& rest) {
  PartHeader header;
  if (rest.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, rest.data(), sizeof header);
  if (checksum(rest.first(16)) != header.header_checksum) throw Error("is damaged");
  const std::span<const std::byte> behind = rest.subspan(sizeof header);
  if (header.size > behind.size()) return std::nullopt;
  const auto part = behind.first(header.size);
  if (checksum(part) != header.checksum) throw Error("is damaged");
  rest = behind.subspan(header.size);
  return part;
}

/// The first line in which the two differ.
std::string difference(const std::string& found, const std::string& expected) {
  std::istringstream x(found), y(expected);
  std::string line_x, line_y;
  for (;;) {
    const bool more_x = static_cast<bool>(std::getline(x, line_x));
    const bool more_y = static_cast<bool>(std::getline(y, line_y));
    if (!more_x) line_x = "nothing";
    if (!more_y) line_y = "nothing";
    if (line_x != line_y)
      return "it has '" + std::string(line_x).append("', expected '").append(line_y) + "'";
    if (!more_x && !more_y) return "no difference";
  }
}

std::int64_t age_s(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) throw Error(std::strerror(errno));
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return static_cast<std::int64_t>(now) - static_cast<std::int64_t>(status.st_mtime);
}

StateFile::Content parsed(std::span<const std::byte> bytes, const std::string& identity) {
  if (bytes.size() < magic.size() || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
    throw Error("is that of another version or machine, or cut off");
  std::span<const std::byte> rest = bytes.subspan(magic.size());
  const auto whose = next_part(rest);
  if (!whose) throw Error("is cut off");
  const std::string found(reinterpret_cast<const char*>(whose->data()), whose->size());
  if (found != identity) throw Error("is that of another rig or version: " + difference(found, identity));
  const auto snapshot = next_part(rest);
  if (!snapshot) throw Error("is cut off");
  StateFile::Content content{{snapshot->begin(), snapshot->end()}, {}};
  while (const auto addition = next_part(rest))
    content.additions.emplace_back(addition->begin(), addition->end());
  return content;
}

}  // namespace

StateFile::StateFile(std::string file, std::string identity)
    : file_(std::move(file)), identity_(std::move(identity)) {
  const std::string lock_file = file_ + ".lock";
  lock_ = open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw error_at(lock_file, 0, "", std::string("cannot be written: ") + std::strerror(errno));
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(lock_);
    throw error_at(file_, 0, "", "is the state of another process that is running; each needs its own");
  }
}

StateFile::~StateFile() {
  if (out_ >= 0) {
    fsync(out_);
    close(out_);
  }
  close(lock_);
}

std::optional<StateFile::Content> StateFile::read() {
  const int fd = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0 && errno == ENOENT) return std::nullopt;
  if (fd < 0) throw error_at(file_, 0, "", std::string("cannot be read: ") + std::strerror(errno));
  std::vector<std::byte> bytes;
  std::int64_t age = 0;
  try {
    bytes = whole(fd);
    age = age_s(fd);
  } catch (const Error& error) {
    close(fd);
    throw error_at(file_, 0, "", std::string("cannot be read: ") + error.what());
  }
  close(fd);
  // somebody's own file must not be moved away because of a slip on the command line
  if (bytes.size() >= magic_of_any_version.size() &&
      std::memcmp(bytes.data(), magic_of_any_version.data(), magic_of_any_version.size()) != 0)
    throw error_at(file_, 0, "", "is not a state of egocal-pairing; expected one, or no file");
  try {
    Content content = parsed(bytes, identity_);
    if (std::abs(age) > most_age_s)
      throw Error("is stale: written " + std::to_string(age) + " s ago, expected at most " +
                  std::to_string(most_age_s));
    return content;
  } catch (const Error& error) {
    refuse(error.what());
    return std::nullopt;
  }
}

void StateFile::refuse(const std::string& why) {
  const std::string aside = file_ + ".refused";
  std::error_code error;
  std::filesystem::rename(file_, aside, error);
  if (error) throw error_at(file_, 0, "", why + ", and cannot be kept aside: " + error.message());
  refused_ = file_ + ": " + why + "; starting anew, it is kept as " + aside;
}

void StateFile::snapshot(std::span<const std::byte> bytes) {
  std::vector<std::byte> content;
  content.reserve(magic.size() + identity_.size() + bytes.size() + 2 * sizeof(PartHeader));
  const auto start = as_bytes(magic);
  content.insert(content.end(), start.begin(), start.end());
  append_part(content, as_bytes(identity_));
  append_part(content, bytes);

  const std::string temporary = file_ + ".new";
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const auto fail = [&](const std::string& why) {
    if (fd >= 0) close(fd);
    unlink(temporary.c_str());
    throw error_at(file_, 0, "", "cannot be written: " + why);
  };
  if (fd < 0) fail(std::strerror(errno));
  try {
    write_all(fd, content);
  } catch (const Error& error) {
    fail(error.what());
  }
  if (fsync(fd) != 0 || std::rename(temporary.c_str(), file_.c_str()) != 0) fail(std::strerror(errno));
  // the name itself must reach the disk too
  const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
  const int directory = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    fsync(directory);
    close(directory);
  }
  if (out_ >= 0) close(out_);
  out_ = fd;
  added_ = 0;
}

void StateFile::add(std::span<const std::byte> bytes) {
  if (out_ < 0) throw error_at(file_, 0, "", "has no snapshot to add to");
  std::vector<std::byte> part;
  part.reserve(sizeof(PartHeader) + bytes.size());
  append_part(part, bytes);
  try {
    write_all(out_, part);
  } catch (const Error& error) {
    // behind an unfinished part nothing may follow
    close(std::exchange(out_, -1));
    throw error_at(file_, 0, "", std::string("cannot be written: ") + error.what());
  }
  added_ += part.size();
}

}  // namespace egocal::services
