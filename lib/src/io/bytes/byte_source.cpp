// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bytes/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include "egocal/error.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t window_size = 256 << 10;  // [bytes]; larger ones are not faster from the page cache
constexpr std::size_t smallest_window = 4 << 10;

}  // namespace

ByteSource::ByteSource(const std::string& file)
    : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_.get() < 0 || ::fstat(descriptor_.get(), &status) != 0)
    throw error_at(file, 0, "", std::string("cannot be opened for reading: ") + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw error_at(file, 0, "", "is a folder, expected a file");
  seekable_ = S_ISREG(status.st_mode);
  size_ = seekable_ ? static_cast<std::uint64_t>(status.st_size) : 0;
  window_.resize(size_ > 0 ? std::clamp<std::uint64_t>(size_, smallest_window, window_size) : window_size);
  fill(8);
  packing_ = packing_of({reinterpret_cast<const char*>(window_.data()), filled_});
  unpacker_ = make_unpacker({window_.data(), filled_});
  if (!unpacker_) return;
  packed_.assign(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(filled_));
  packed_end_ = filled_;
  packed_.resize(window_.size());
  window_.resize(window_size);
  filled_ = 0;
  end_ = false;
}

std::size_t ByteSource::read_raw(unsigned char* to, std::size_t size) {
  while (true) {
    const ssize_t got = ::read(descriptor_.get(), to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) throw error_at(file_, 0, "", std::string("reading failed: ") + std::strerror(errno));
  }
}

std::size_t ByteSource::read_unpacked(unsigned char* to, std::size_t size) {
  while (true) {
    if (packed_at_ == packed_end_) {
      packed_at_ = 0;
      packed_end_ = read_raw(packed_.data(), packed_.size());
    }
    const bool last = packed_at_ == packed_end_;
    const Unpacker::Step step =
        unpacker_->unpack({packed_.data() + packed_at_, packed_end_ - packed_at_}, {to, size});
    packed_at_ += step.consumed;
    const bool stuck = step.consumed == 0 && step.produced == 0;
    if (step.failed)
      failure_ = step.checksum ? Failure::checksum : Failure::damaged;
    else if (stuck && !(last && unpacker_->complete()))
      failure_ = last ? Failure::cut_off : Failure::damaged;
    if (step.produced > 0 || stuck || step.failed) return step.produced;
  }
}

void ByteSource::fill(std::size_t size) {
  if (filled_ - position_ >= size || end_) return;
  std::copy(window_.begin() + static_cast<std::ptrdiff_t>(position_),
            window_.begin() + static_cast<std::ptrdiff_t>(filled_), window_.begin());
  window_offset_ += position_;
  filled_ -= position_;
  position_ = 0;
  while (filled_ < size && !end_) {
    // grows as bytes really come: a length that lies in a short file costs nothing
    if (filled_ == window_.size()) window_.resize(std::min(std::max(size, window_size), 2 * window_.size()));
    const std::size_t room = window_.size() - filled_;
    const std::size_t got =
        unpacker_ ? read_unpacked(window_.data() + filled_, room) : read_raw(window_.data() + filled_, room);
    end_ = got == 0 || failure_ != Failure::none;
    filled_ += got;
  }
}

ByteSpan ByteSource::peek(std::size_t size) {
  fill(size);
  return {window_.data() + position_, std::min(size, filled_ - position_)};
}

std::uint64_t ByteSource::skip(std::uint64_t size) {
  std::uint64_t passed = std::min<std::uint64_t>(size, filled_ - position_);
  position_ += passed;
  if (passed < size && seekable_ && !unpacker_) {
    const std::uint64_t jump = std::min(size - passed, size_ > offset() ? size_ - offset() : 0);
    if (jump > 0 && ::lseek(descriptor_.get(), static_cast<off_t>(jump), SEEK_CUR) >= 0) {
      window_offset_ += position_ + jump;
      position_ = filled_ = 0;
      return passed + jump;
    }
  }
  while (passed < size) {
    const std::size_t there =
        peek(static_cast<std::size_t>(std::min<std::uint64_t>(window_size, size - passed))).size();
    if (there == 0) break;
    position_ += there;
    passed += there;
  }
  return passed;
}

void ByteSource::count_unpacking(ReadLosses& losses) {
  if (std::exchange(counted_, true)) return;
  switch (failure_) {
    case Failure::none:
      return;
    case Failure::cut_off:
      losses.truncated = true;
      return;
    case Failure::checksum:
      losses.checksum = true;
      return;
    case Failure::damaged:
      ++losses.regions;
      losses.bytes += packed_left();
      return;
  }
}

std::string ByteSource::why_empty() const {
  if (!packing_ || failure_ == Failure::none) return "holds no data";
  return "holds no data: what is packed by " + std::string(packing_->name) + " is " + what_failed() +
         " before the first row";
}

void ByteSource::read_content(const std::function<void()>& content) {
  try {
    content();
  } catch (const Error& error) {
    std::string fault = error.what();
    if (!packing_ || fault.ends_with(why_empty()) || !fails_to_unpack()) throw;
    if (fault.starts_with(file_ + ":")) fault.erase(0, file_.size() + 1);
    fault.erase(0, fault.find_first_not_of(' '));
    const bool of_line = !fault.empty() && std::isdigit(static_cast<unsigned char>(fault.front())) != 0;
    throw error_at(file_, 0, "",
                   "what is packed by " + std::string(packing_->name) + " is " + what_failed() +
                       ": copy the file again (as unpacked, " + (of_line ? "line " : "") + fault + ")");
  }
}

/// Whether unpacking fails anywhere up to the end of the file, to which this reads.
bool ByteSource::fails_to_unpack() {
  try {
    while (unpacker_ && skip(window_size) > 0) {
    }
  } catch (const Error&) {
    return false;  // reading failed
  }
  return failure_ != Failure::none;
}

const char* ByteSource::what_failed() const {
  return failure_ == Failure::cut_off ? "cut off" : "damaged";
}

/// Bytes left of the packed file, from where unpacking has ended; of a pipe those that have been read.
std::uint64_t ByteSource::packed_left() const {
  const std::uint64_t read = packed_end_ - packed_at_;
  const off_t at = seekable_ ? ::lseek(descriptor_.get(), 0, SEEK_CUR) : -1;
  return read +
         (at >= 0 && static_cast<std::uint64_t>(at) < size_ ? size_ - static_cast<std::uint64_t>(at) : 0);
}

void ByteSource::rewind() {
  counted_ = false;
  if (window_offset_ == 0) {
    position_ = 0;
    return;
  }
  if (!seekable_ || ::lseek(descriptor_.get(), 0, SEEK_SET) != 0)
    throw error_at(file_, 0, "", "is a pipe and has to be read twice; save it to a file first");
  window_offset_ = 0;
  position_ = filled_ = packed_at_ = packed_end_ = 0;
  end_ = false;
  failure_ = Failure::none;
  if (unpacker_) unpacker_->restart();
}

}  // namespace egocal::detail
