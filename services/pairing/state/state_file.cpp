// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/state/state_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "pairing/state/archive.hpp"

namespace egocal::services {

namespace {

/// The last character tells the byte order of the machine apart.
const std::string magic = [] {
  const std::uint16_t one = 1;
  std::uint8_t low = 0;
  std::memcpy(&low, &one, 1);
  return std::string("egocal-pairing state 2") + (low ? "l" : "b") + "\n";
}();
constexpr int most_refused = 100;
const std::string magic_of_any_version = "egocal-pairing state ";

/// Before each part: identity, snapshot, additions.
struct PartHeader {
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;         ///< of the part
  std::int64_t boot_us = 0;           ///< when it was written, see BootTime
  std::uint64_t header_checksum = 0;  ///< of those above
};

std::uint64_t own_checksum(const PartHeader& header) {
  return checksum(std::as_bytes(std::span(&header, 1)).first(sizeof header - sizeof header.header_checksum));
}

PartHeader header_of(std::span<const std::byte> bytes, std::int64_t boot_us) {
  PartHeader header{bytes.size(), checksum(bytes), boot_us, 0};
  header.header_checksum = own_checksum(header);
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

void append_part(std::vector<std::byte>& out, std::span<const std::byte> part, std::int64_t boot_us) {
  const PartHeader header = header_of(part, boot_us);
  const auto header_bytes = std::as_bytes(std::span(&header, 1));
  out.insert(out.end(), header_bytes.begin(), header_bytes.end());
  out.insert(out.end(), part.begin(), part.end());
}

/// A state of the largest rigs has some megabytes.
constexpr std::int64_t largest_state = std::int64_t{256} << 20;

/// The file, checked before its content is read: a user's own file must not be moved away because of a
/// slip on the command line, nor a pipe be waited for. Empty: there is none.
std::optional<std::vector<std::byte>> whole(const std::string& file, std::int64_t& time_s) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0 && errno == ENOENT) return std::nullopt;
  const auto fail = [&](const std::string& why) {
    if (fd >= 0) close(fd);
    throw error_at(file, 0, "", why);
  };
  if (fd < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(fd, &status) != 0) fail(std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) fail("is not a file; expected a state of egocal-pairing, or no file");
  time_s = status.st_mtime;
  std::vector<std::byte> bytes;
  const std::int64_t most = std::min<std::int64_t>(status.st_size, largest_state);
  const auto read_up_to = [&](std::size_t size) {
    std::size_t have = bytes.size();
    bytes.resize(size);
    while (have < size) {
      const ssize_t got = ::read(fd, bytes.data() + have, size - have);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
      if (got == 0) break;
      have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
  };
  read_up_to(std::min(static_cast<std::size_t>(most), magic_of_any_version.size()));
  if (bytes.size() == magic_of_any_version.size() &&
      std::memcmp(bytes.data(), magic_of_any_version.data(), bytes.size()) != 0)
    fail("is not a state of egocal-pairing; expected one, or no file");
  read_up_to(static_cast<std::size_t>(most));
  close(fd);
  return bytes;
}

/// The next part; empty where the bytes end before it does.
std::optional<std::span<const std::byte>> next_part(std::span<const std::byte>& rest, std::int64_t& boot_us) {
  PartHeader header;
  if (rest.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, rest.data(), sizeof header);
  if (own_checksum(header) != header.header_checksum) throw Error("is damaged");
  const std::span<const std::byte> behind = rest.subspan(sizeof header);
  if (header.size > behind.size()) return std::nullopt;
  const auto part = behind.first(header.size);
  if (checksum(part) != header.checksum) throw Error("is damaged");
  rest = behind.subspan(header.size);
  boot_us = header.boot_us;
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

struct Parsed {
  StateFile::Content content;
  BootTime written;  ///< the last part
};

Parsed parsed(std::span<const std::byte> bytes, const std::string& identity) {
  if (bytes.size() < magic.size() || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
    throw Error("is that of another version or machine, or cut off");
  std::span<const std::byte> rest = bytes.subspan(magic.size());
  Parsed result;
  const auto whose = next_part(rest, result.written.us);
  if (!whose) throw Error("is cut off");
  const std::string found(reinterpret_cast<const char*>(whose->data()), whose->size());
  if (found != identity) throw Error("is that of another rig or version: " + difference(found, identity));
  const auto boot = next_part(rest, result.written.us);
  if (!boot) throw Error("is cut off");
  result.written.boot.assign(reinterpret_cast<const char*>(boot->data()), boot->size());
  const auto snapshot = next_part(rest, result.written.us);
  if (!snapshot) throw Error("is cut off");
  result.content.snapshot.assign(snapshot->begin(), snapshot->end());
  while (const auto addition = next_part(rest, result.written.us))
    result.content.additions.emplace_back(addition->begin(), addition->end());
  return result;
}

}  // namespace

StateFile::StateFile(const std::string& file, std::string identity, Clock clock)
    : file_(without_links(file)), identity_(std::move(identity)), clock_(std::move(clock)), lock_(file_) {
  remove_temporaries(file_);
}

StateFile::~StateFile() {
  if (out_ < 0) return;
  fsync(out_);
  close(out_);
}

std::optional<StateFile::Content> StateFile::read() {
  std::int64_t time_s = 0;
  const std::optional<std::vector<std::byte>> bytes = whole(file_, time_s);
  if (!bytes) return std::nullopt;
  try {
    Parsed found = parsed(*bytes, identity_);
    const std::int64_t age = age_s(found.written, clock_(), time_s, std::time(nullptr));
    if (std::abs(age) > most_age_s)
      throw Error("is stale: written " + std::to_string(age) + " s ago, expected at most " +
                  std::to_string(most_age_s));
    return std::move(found.content);
  } catch (const Error& error) {
    refuse(error.what());
    return std::nullopt;
  }
}

void StateFile::refuse(const std::string& why) {
  // what was kept before stays, too: it may be hours of driving
  std::string aside = file_ + ".refused";
  std::error_code error;
  for (int n = 2; n <= most_refused && std::filesystem::exists(aside, error); ++n)
    aside = file_ + ".refused-" + std::to_string(n);
  std::filesystem::rename(file_, aside, error);
  if (error) throw error_at(file_, 0, "", why + ", and cannot be kept aside: " + error.message());
  refused_ = file_ + ": " + why + "; starting anew, it is kept as " + aside;
}

void StateFile::snapshot(std::span<const std::byte> bytes) {
  // the folder was there when this began: its removal was not meant for what is known here
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(file_).parent_path(), none);
  lock_.confirm();
  std::vector<std::byte> parts;
  const BootTime now = clock_();
  append_part(parts, as_bytes(identity_), now.us);
  append_part(parts, as_bytes(now.boot), now.us);
  append_part(parts, bytes, now.us);
  WholeFile whole(file_);
  whole.write(magic);
  whole.write(parts);
  whole.commit();
  if (out_ >= 0) close(out_);
  out_ = whole.release_descriptor();
  added_ = 0;
}

bool StateFile::in_place() const {
  struct stat status {};
  return out_ >= 0 && fstat(out_, &status) == 0 && status.st_nlink > 0;
}

void StateFile::add(std::span<const std::byte> bytes) {
  if (out_ < 0) throw error_at(file_, 0, "", "has no snapshot to add to");
  std::vector<std::byte> part;
  part.reserve(sizeof(PartHeader) + bytes.size());
  append_part(part, bytes, clock_().us);
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
