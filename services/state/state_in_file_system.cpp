// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_medium.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/io/descriptor.hpp"
#include "egocal/io/whole_file.hpp"
#include "state/state_lock.hpp"

namespace egocal::services {

namespace {

/// Opens the file and checks it before reading: a file named by mistake must not be moved away, and a pipe
/// must not block. Empty: there is no file.
std::optional<StateMedium::Found> whole(const std::string& file, const StateMedium::Expected& expected,
                                        const StateOptions& options) {
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const int fd = opened.get();
  if (fd < 0 && errno == ENOENT) return std::nullopt;
  const auto fail = [&](const std::string& why) { throw error_at(file, 0, "", why); };
  if (fd < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(fd, &status) != 0) fail(std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(status.st_mode))
    fail("is not a file; expected a state of " + expected.process + ", or no file");
  StateMedium::Found found{{}, status.st_mtime, std::time(nullptr)};
  std::vector<std::byte>& bytes = found.bytes;
  const std::int64_t most = std::min<std::int64_t>(status.st_size, options.largest_state);
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
  std::size_t longest = 0;
  for (const std::string& begin : expected.begins) longest = std::max(longest, begin.size());
  read_up_to(std::min(static_cast<std::size_t>(most), longest));
  // compares a short file as far as it goes: a truncated state is one, a short file of the user is none
  const auto begins_so = [&bytes](const std::string& begin) {
    return std::memcmp(bytes.data(), begin.data(), std::min(bytes.size(), begin.size())) == 0;
  };
  if (std::none_of(expected.begins.begin(), expected.begins.end(), begins_so))
    throw not_a_state(file, expected.process);
  read_up_to(static_cast<std::size_t>(most));
  return found;
}

class StateInFileSystem final : public StateMedium {
 public:
  StateInFileSystem(const std::string& file, const StateOptions& options)
      : options_(options), file_(without_links(file)), lock_(file_) {
    remove_temporaries(file_);
  }
  ~StateInFileSystem() override {
    if (out_ < 0) return;
    fsync(out_);
    close(out_);
  }

  const std::string& name() const override { return file_; }
  std::optional<Found> read(const Expected& expected) override { return whole(file_, expected, options_); }

  void replace(std::span<const std::byte> bytes) override {
    // the folder existed at the start; its removal was not meant to lose the current state
    std::error_code none;
    std::filesystem::create_directories(std::filesystem::path(file_).parent_path(), none);
    lock_.confirm();
    WholeFile whole(file_);
    whole.write(bytes);
    whole.commit();
    if (out_ >= 0) close(out_);
    out_ = whole.release_descriptor();
    size_ = static_cast<std::int64_t>(bytes.size());
  }

  void add(std::span<const std::byte> bytes) override {
    if (out_ < 0) throw error_at(file_, 0, "", "has no snapshot to add to");
    try {
      if (!write_all(out_, bytes)) throw Error(std::strerror(errno));
      size_ += static_cast<std::int64_t>(bytes.size());
    } catch (const Error& error) {
      // behind an unfinished part nothing may follow
      close(std::exchange(out_, -1));
      throw error_at(file_, 0, "", std::string("cannot be written: ") + error.what());
    }
  }

  bool in_place() const override {
    struct stat ours {
    }, there{};
    return out_ >= 0 && fstat(out_, &ours) == 0 && stat(file_.c_str(), &there) == 0 &&
           ours.st_ino == there.st_ino && ours.st_dev == there.st_dev && ours.st_size == size_;
  }

  std::string keep_aside() override {
    // what was kept before stays, too: it may be hours of driving
    std::string aside = file_ + ".refused";
    std::error_code error;
    for (int n = 2; n <= options_.most_refused && std::filesystem::exists(aside, error); ++n)
      aside = file_ + ".refused-" + std::to_string(n);
    std::filesystem::rename(file_, aside, error);
    if (error) throw Error("cannot be kept aside: " + error.message());
    return aside;
  }

 private:
  StateOptions options_;
  std::string file_;
  StateLock lock_;
  int out_ = -1;
  std::int64_t size_ = 0;  ///< of what was written [bytes]
};

}  // namespace

Error not_a_state(const std::string& file, const std::string& process) {
  return error_at(file, 0, "", "is not a state of " + process + "; expected one, or no file");
}

std::unique_ptr<StateMedium> open_state_medium(const std::string& file, const StateOptions& options) {
  return std::make_unique<StateInFileSystem>(file, options);
}

}  // namespace egocal::services
