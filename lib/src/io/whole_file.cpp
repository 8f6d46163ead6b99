// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/whole_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/io/descriptor.hpp"

namespace egocal {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = 1 << 16;  // [bytes]
constexpr int most_links = 40;                // as the kernel follows
constexpr int most_temporaries = 1000;        // a limit: names that are tried
constexpr std::string_view temporary_suffix = ".part";

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Syncs the folder: the name must reach the disk as well. Not every file system can do it.
void sync_folder(const std::string& file) {
  const int fd = open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

/// Whether the path is in /proc, whose links look like links to files but are the open files of a process.
bool in_proc(const fs::path& file) {
  struct statfs system {};
  return statfs(folder_of(file).c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

/// Where the links of a path lead: the file, or a link of /proc such as that of /dev/stdout.
fs::path end_of_links(const std::string& path, bool into_proc = false) {
  fs::path file(path);
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(file, error) && (into_proc || !in_proc(file)); ++i) {
    const fs::path to = fs::read_symlink(file, error);
    if (error) break;
    file = to.is_absolute() ? to : file.parent_path() / to;
  }
  return file;
}

/// The descriptor of this process that the path is a name of. Opened by its name, a file that standard output
/// is appended to would be written from its beginning.
std::optional<int> own_descriptor(const std::string& path) {
  const fs::path link = end_of_links(path);
  std::error_code error;
  if (!in_proc(link) || !fs::equivalent(folder_of(link), "/proc/self/fd", error)) return std::nullopt;
  const std::string name = link.filename();
  int number = -1;
  const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (failed != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

/// Opens what cannot be replaced, for writing at its end.
int open_in_place(const std::string& path) {
  const std::optional<int> own = own_descriptor(path);
  if (!own) return open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  std::fflush(stdout);  // after what was printed before
  return fcntl(*own, F_DUPFD_CLOEXEC, 0);
}

std::string link_of(int fd) {
  return "/proc/self/fd/" + std::to_string(fd);
}

/// A file without a name, of which nothing is left where the process is killed. -1: the file system has none,
/// or /proc is not there to name it by later.
int open_unnamed(const fs::path& folder) {
  const int fd = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0 || access(link_of(fd).c_str(), F_OK) == 0) return fd;
  close(fd);
  return -1;
}

}  // namespace

bool write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

bool can_be_replaced(const std::string& path) {
  if (in_proc(end_of_links(path))) return false;
  std::error_code none;
  const fs::file_status there = fs::status(path, none);
  return !fs::exists(there) || fs::is_regular_file(there);
}

std::string without_links(const std::string& path) {
  const fs::path file = end_of_links(path, true);
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(file), error);
  return error ? file.string() : (folder / file.filename()).string();
}

namespace {

/// Whether what is between the file's name and the suffix was made by name_temporary(): of a process and a
/// number. A file beside it may have a name that only begins so, and temporaries of its own.
bool is_of_process(std::string_view middle) {
  const std::size_t dash = middle.find('-');
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && is_number(middle.substr(0, dash)) &&
         is_number(middle.substr(dash + 1));
}

}  // namespace

void remove_temporaries(const std::string& file) {
  const fs::path target(without_links(file));
  const std::string start = target.filename().string() + ".";
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(target.parent_path(), error)) {
    const std::string name = entry.path().filename();
    std::error_code none;
    if (!name.starts_with(start) || !name.ends_with(temporary_suffix)) continue;
    const std::string_view after = std::string_view(name).substr(start.size());
    if (after.size() > temporary_suffix.size() &&
        is_of_process(after.substr(0, after.size() - temporary_suffix.size())))
      fs::remove(entry.path(), none);
  }
}

WholeFile::WholeFile(const std::string& file) : file_(file), target_(without_links(file)) {
  struct stat there {};
  const bool exists = stat(target_.c_str(), &there) == 0;
  if (!can_be_replaced(file)) fail("is there and is not a file that could be replaced");
  fd_ = open_unnamed(folder_of(target_));
  if (fd_ < 0)
    name_temporary([this](const char* name) {
      fd_ = open(name, O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
      return fd_ >= 0;
    });
  if (exists && fchmod(fd_, there.st_mode & 07777) != 0) {
    // a file of another owner: it gets the usual permissions
  }
  buffer_.reserve(buffer_size);
}

WholeFile::~WholeFile() {
  if (fd_ >= 0) close(fd_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

/// Takes the first temporary name that `take` succeeds with.
void WholeFile::name_temporary(const std::function<bool(const char*)>& take) {
  for (int n = 0; temporary_.empty(); ++n) {
    const std::string name =
        target_ + "." + std::to_string(getpid()) + "-" + std::to_string(n) + std::string(temporary_suffix);
    if (take(name.c_str()))
      temporary_ = name;
    else if (errno != EEXIST || n == most_temporaries)
      fail(std::string("cannot be written: ") + std::strerror(errno));
  }
}

void WholeFile::fail(const std::string& why) const {
  throw error_at(file_, 0, "", why);
}

void WholeFile::flush() {
  if (!write_all(fd_, buffer_)) fail(std::string("cannot be written: ") + std::strerror(errno));
  buffer_.clear();
}

void WholeFile::write(std::span<const std::byte> bytes) {
  if (committed_) fail("is complete; nothing can be written to it any more");
  if (buffer_.size() + bytes.size() > buffer_size) flush();
  if (bytes.size() < buffer_size)
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  else if (!write_all(fd_, bytes))
    fail(std::string("cannot be written: ") + std::strerror(errno));
}

void WholeFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

/// Brings all to the disk, under a temporary name.
void WholeFile::complete() {
  flush();
  if (fsync(fd_) != 0) fail(std::string("cannot be written: ") + std::strerror(errno));
  // a name cannot be given to it in place of another file's
  name_temporary([unnamed = link_of(fd_)](const char* name) {
    return linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
  });
}

void WholeFile::take_name() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
    fail(std::string("cannot be written: ") + std::strerror(errno));
  took_name();
}

void WholeFile::took_name() {
  temporary_.clear();
  committed_ = true;
  sync_folder(target_);
}

void WholeFile::commit() {
  if (committed_) return;
  complete();
  take_name();
}

bool WholeFile::commit_as_new() {
  complete();
  if (renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
    took_name();
    return true;
  }
  if (errno == EEXIST) return false;
  // NFS and others can only replace: an empty file keeps the name free of others for the moment before that
  const Descriptor reserved(open(target_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (reserved.get() < 0 && errno == EEXIST) return false;
  if (reserved.get() < 0) fail(std::string("cannot be written: ") + std::strerror(errno));
  try {
    take_name();
  } catch (...) {
    unlink(target_.c_str());
    throw;
  }
  return true;
}

int WholeFile::release_descriptor() {
  return std::exchange(fd_, -1);
}

bool write_new_file(const std::string& file, std::string_view content) {
  std::error_code none;
  if (fs::exists(fs::symlink_status(file, none))) return false;
  WholeFile whole(file);
  whole.write(content);
  return whole.commit_as_new();
}

void write_whole_file(const std::string& file, std::string_view content) {
  std::error_code none;
  if (can_be_replaced(file) || fs::is_directory(file, none)) {
    WholeFile whole(file);
    whole.write(content);
    whole.commit();
    return;
  }
  const int fd = open_in_place(file);
  const bool written = fd >= 0 && write_all(fd, std::as_bytes(std::span(content)));
  const int reason = errno;
  if (fd >= 0) close(fd);
  if (!written) throw error_at(file, 0, "", std::string("cannot be written: ") + std::strerror(reason));
}

}  // namespace egocal
