// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace egocal {

/// A file that takes its name when it is complete and on the disk: a reader of the name sees the old file
/// or the new one, even after a power cut. Until then it has none, and goes when the object or the process
/// does. Where the file system has no such files (NFS), the content is in a temporary file beside it
/// (FILE.PID-N.part, a new one each time), which a killed process leaves behind. Where the name is a symbolic
/// link, the file that it points to is replaced, and a file that is replaced hands on its permissions.
class WholeFile {
 public:
  /// Throws Error where the file cannot be written, or where the name cannot be replaced.
  explicit WholeFile(const std::string& file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Writes more of the file. Throws Error, e.g. where the disk is full.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Gives the file its name. Throws Error; what had the name before is then still there. Nothing can be
  /// written afterwards but to the file descriptor; a second call does nothing.
  void commit();
  /// Gives the file its name where no file has it. False: one has it, and nothing was written.
  bool commit_as_new();
  /// Hands over the file after commit(), open for writing at its end. The caller closes it.
  int release_descriptor();

 private:
  void flush();
  void complete();
  void take_name();
  void took_name();
  void name_temporary(const std::function<bool(const char*)>& take);
  [[noreturn]] void fail(const std::string& why) const;

  std::string file_;       ///< as given, for messages
  std::string target_;     ///< without symbolic links
  std::string temporary_;  ///< empty: it has no name
  bool committed_ = false;
  std::vector<std::byte> buffer_;
  int fd_ = -1;
};

/// Whether a WholeFile can have this name: no, where it is a device, a pipe or a folder, or a name of what a
/// process has open (/dev/stdout, /dev/fd/3), also where that is a file.
bool can_be_replaced(const std::string& file);

/// Writes the whole file or nothing, by a WholeFile. What cannot be replaced is written to as it is, at its
/// end; /dev/stdout after what was printed before. Throws Error.
void write_whole_file(const std::string& file, std::string_view content);

/// Writes the whole file under a name that no file has. False: one has it. Throws Error.
bool write_new_file(const std::string& file, std::string_view content);

/// Writes all of the bytes to what a descriptor has open. False: not all, and errno tells why.
bool write_all(int fd, std::span<const std::byte> bytes);

/// The file that a path names once all symbolic links are followed, whether it exists or not.
std::string without_links(const std::string& path);

/// Removes what a WholeFile of this name left behind when its process was killed. Only for the one process
/// that writes this file.
void remove_temporaries(const std::string& file);

}  // namespace egocal
