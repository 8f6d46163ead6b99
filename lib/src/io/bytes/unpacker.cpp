// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bytes/unpacker.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <new>

namespace egocal::detail {

namespace {

constexpr std::size_t largest_step = std::numeric_limits<unsigned int>::max() / 2;
/// Size of the first input of zstd and lz4, which then ask for as much as they need for a block: what a call
/// unpacks before it finds damage is lost, so no call is given more.
constexpr std::size_t first_input = 4;  // [bytes]

class Gzip : public Unpacker {
 public:
  Gzip() {
    if (inflateInit2(&stream_, 15 + 16) != Z_OK) throw std::bad_alloc();
  }
  ~Gzip() override { inflateEnd(&stream_); }
  Gzip(const Gzip&) = delete;
  Gzip& operator=(const Gzip&) = delete;

  Step unpack(std::span<const unsigned char> from, std::span<unsigned char> to) override {
    if (complete_ && !from.empty()) restart();  // gzip files may be joined
    stream_.next_in = const_cast<unsigned char*>(from.data());
    stream_.avail_in = static_cast<unsigned int>(std::min(from.size(), largest_step));
    stream_.next_out = to.data();
    stream_.avail_out = static_cast<unsigned int>(std::min(to.size(), largest_step));
    const unsigned int in = stream_.avail_in, out = stream_.avail_out;
    const int result = complete_ ? Z_OK : inflate(&stream_, Z_NO_FLUSH);
    complete_ = complete_ || result == Z_STREAM_END;
    // of the sum and of the length at the end of the data
    const std::string_view why = result == Z_DATA_ERROR && stream_.msg ? stream_.msg : "";
    return {in - stream_.avail_in, out - stream_.avail_out,
            result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR,
            why == "incorrect data check" || why == "incorrect length check"};
  }
  void restart() override {
    inflateReset(&stream_);
    complete_ = false;
  }
  bool complete() const override { return complete_; }

 private:
  z_stream stream_{};
  bool complete_ = false;
};

class Bzip2 : public Unpacker {
 public:
  Bzip2() { begin(); }
  ~Bzip2() override { BZ2_bzDecompressEnd(&stream_); }
  Bzip2(const Bzip2&) = delete;
  Bzip2& operator=(const Bzip2&) = delete;

  Step unpack(std::span<const unsigned char> from, std::span<unsigned char> to) override {
    if (complete_ && from.empty()) return {};
    if (complete_) restart();  // bzip2 files may be joined, and parallel programs write many streams
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(from.data()));
    stream_.avail_in = static_cast<unsigned int>(std::min(from.size(), largest_step));
    stream_.next_out = reinterpret_cast<char*>(to.data());
    stream_.avail_out = static_cast<unsigned int>(std::min(to.size(), largest_step));
    const unsigned int in = stream_.avail_in, out = stream_.avail_out;
    const int result = BZ2_bzDecompress(&stream_);
    complete_ = result == BZ_STREAM_END;
    return {in - stream_.avail_in, out - stream_.avail_out, result != BZ_OK && result != BZ_STREAM_END};
  }
  void restart() override {
    BZ2_bzDecompressEnd(&stream_);
    begin();
  }
  bool complete() const override { return complete_; }

 private:
  void begin() {
    stream_ = {};
    complete_ = false;
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  bz_stream stream_{};
  bool complete_ = false;
};

class Zstd : public Unpacker {
 public:
  Zstd() : context_(ZSTD_createDCtx()) {
    if (!context_) throw std::bad_alloc();
    // window of at most 64 MiB: what a damaged header asks for is bounded
    ZSTD_DCtx_setParameter(context_, ZSTD_d_windowLogMax, 26);
  }
  ~Zstd() override { ZSTD_freeDCtx(context_); }
  Zstd(const Zstd&) = delete;
  Zstd& operator=(const Zstd&) = delete;

  Step unpack(std::span<const unsigned char> from, std::span<unsigned char> to) override {
    ZSTD_inBuffer in{from.data(), std::min(from.size(), next_), 0};
    ZSTD_outBuffer out{to.data(), to.size(), 0};
    const std::size_t result = ZSTD_decompressStream(context_, &out, &in);
    const bool failed = ZSTD_isError(result) != 0;
    next_ = failed || result == 0 ? first_input : result;
    if (in.pos > 0 || out.pos > 0) complete_ = !failed && result == 0;
    return {in.pos, out.pos, failed, ZSTD_getErrorCode(result) == ZSTD_error_checksum_wrong};
  }
  void restart() override {
    ZSTD_DCtx_reset(context_, ZSTD_reset_session_only);
    next_ = first_input;
    complete_ = false;
  }
  bool complete() const override { return complete_; }

 private:
  ZSTD_DCtx* context_;
  std::size_t next_ = first_input;
  bool complete_ = false;
};

class Lz4 : public Unpacker {
 public:
  Lz4() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION))) throw std::bad_alloc();
  }
  ~Lz4() override { LZ4F_freeDecompressionContext(context_); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;

  Step unpack(std::span<const unsigned char> from, std::span<unsigned char> to) override {
    std::size_t in = std::min(from.size(), next_), out = to.size();
    const std::size_t result = LZ4F_decompress(context_, to.data(), &out, from.data(), &in, nullptr);
    const bool failed = LZ4F_isError(result) != 0;
    next_ = failed || result == 0 ? first_input : result;
    if (in > 0 || out > 0) complete_ = !failed && result == 0;
    return {in, out, failed,
            failed && std::string_view(LZ4F_getErrorName(result)) == "ERROR_contentChecksum_invalid"};
  }
  void restart() override {
    LZ4F_resetDecompressionContext(context_);
    next_ = first_input;
    complete_ = false;
  }
  bool complete() const override { return complete_; }

 private:
  LZ4F_dctx* context_ = nullptr;
  std::size_t next_ = first_input;
  bool complete_ = false;
};

}  // namespace

std::unique_ptr<Unpacker> make_unpacker(std::span<const unsigned char> first_bytes) {
  const auto begins_with = [&](std::initializer_list<unsigned char> magic) {
    return first_bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), first_bytes.begin());
  };
  if (begins_with({0x1f, 0x8b})) return std::make_unique<Gzip>();
  if (begins_with({0x28, 0xb5, 0x2f, 0xfd})) return std::make_unique<Zstd>();
  if (begins_with({'B', 'Z', 'h'})) return std::make_unique<Bzip2>();
  if (begins_with({0x04, 0x22, 0x4d, 0x18})) return std::make_unique<Lz4>();
  return nullptr;
}

std::unique_ptr<Unpacker> make_unpacker(std::string_view name) {
  if (name == "zstd") return std::make_unique<Zstd>();
  if (name == "lz4") return std::make_unique<Lz4>();
  if (name == "bz2") return std::make_unique<Bzip2>();
  return nullptr;
}

bool unpack_all(Unpacker& unpacker, std::span<const unsigned char> packed, std::size_t most,
                std::vector<unsigned char>& out) {
  unpacker.restart();
  std::size_t made = 0, used = 0;
  out.resize(std::min(most, std::max<std::size_t>(out.size(), 64 << 10)));
  while (true) {
    const auto step = unpacker.unpack(packed.subspan(used), std::span(out).subspan(made));
    used += step.consumed;
    made += step.produced;
    if (step.failed || (unpacker.complete() && used == packed.size())) break;
    const bool full = made == out.size();
    if (full && made == most) break;
    if (full) out.resize(std::min(most, 2 * out.size()));
    if (!full && step.consumed == 0 && step.produced == 0) break;  // cut off
  }
  out.resize(made);
  return unpacker.complete() && used == packed.size();
}

}  // namespace egocal::detail
