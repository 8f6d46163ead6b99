// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/datagrams.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "egocal/bus/check.hpp"

namespace egocal::bus {

namespace {

constexpr std::uint32_t whole_magic = 0x4c433032;     // "LC02"
constexpr std::uint32_t fragment_magic = 0x4c433033;  // "LC03"
constexpr std::size_t whole_header = 8;               // bytes, format
constexpr std::size_t fragment_header = 20;           // bytes, format
/// LCM_SHORT_MESSAGE_MAX_SIZE and LCM_FRAGMENT_MAX_PAYLOAD: of channel, its final zero and data.
constexpr std::size_t max_whole_payload = 65499;
constexpr std::size_t max_fragment_payload = 65487;  // bytes, format
constexpr std::size_t max_fragments = 65535;         // format

/// The channel name at the start, without its final zero; empty where there is none.
std::string_view channel_at(Bytes bytes) {
  const std::size_t most = std::min(bytes.size(), max_channel_length + 1);
  const char* begin = reinterpret_cast<const char*>(bytes.data());
  const void* end = most == 0 ? nullptr : std::memchr(begin, 0, most);
  return end ? std::string_view(begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin))
             : std::string_view{};
}

class HeaderWriter {
 public:
  explicit HeaderWriter(Datagram& datagram) : datagram_(datagram) { datagram_.header_size = 0; }

  void number32(std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) put(static_cast<std::byte>(value >> shift & 0xff));
  }
  void number16(std::uint32_t value) {
    put(static_cast<std::byte>(value >> 8 & 0xff));
    put(static_cast<std::byte>(value & 0xff));
  }
  void channel(std::string_view name) {
    for (const char c : name) put(static_cast<std::byte>(c));
    put(std::byte{0});
  }

 private:
  void put(std::byte value) { datagram_.header_storage[datagram_.header_size++] = value; }
  Datagram& datagram_;
};

bool send_fragments(std::string_view channel, Bytes bytes, std::uint32_t number,
                    const std::function<bool(const Datagram&)>& send) {
  const std::size_t first = max_fragment_payload - (channel.size() + 1);
  const std::size_t fragments = 1 + (bytes.size() - first + max_fragment_payload - 1) / max_fragment_payload;
  Datagram datagram;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < fragments; ++i) {
    const std::size_t size = i == 0 ? first : std::min(max_fragment_payload, bytes.size() - offset);
    HeaderWriter header(datagram);
    header.number32(fragment_magic);
    header.number32(number);
    header.number32(static_cast<std::uint32_t>(bytes.size()));
    header.number32(static_cast<std::uint32_t>(offset));
    header.number16(static_cast<std::uint32_t>(i));
    header.number16(static_cast<std::uint32_t>(fragments));
    if (i == 0) header.channel(channel);
    datagram.payload = bytes.subspan(offset, size);
    offset += size;
    if (!send(datagram)) return false;
  }
  return true;
}

}  // namespace

bool fits_datagrams(std::string_view channel, Bytes bytes) {
  return !channel.empty() && channel.size() <= max_channel_length &&
         channel.find('\0') == std::string_view::npos &&
         bytes.size() <= max_fragments * max_fragment_payload - (max_channel_length + 1);
}

bool for_each_datagram(std::string_view channel, Bytes bytes, std::uint32_t number,
                       const std::function<bool(const Datagram&)>& send) {
  if (!fits_datagrams(channel, bytes)) return false;
  if (channel.size() + 1 + bytes.size() > max_whole_payload)
    return send_fragments(channel, bytes, number, send);
  Datagram datagram;
  HeaderWriter header(datagram);
  header.number32(whole_magic);
  header.number32(number);
  header.channel(channel);
  datagram.payload = bytes;
  return send(datagram);
}

std::optional<Reassembly::Message> Reassembly::take(Bytes datagram, std::uint64_t sender,
                                                    const Wanted& wanted) {
  if (datagram.size() < whole_header) return refuse();
  switch (big_endian<std::uint32_t>(datagram)) {
    case whole_magic:
      return take_whole(datagram.subspan(whole_header), wanted);
    case fragment_magic:
      return take_fragment(datagram, sender, wanted);
    default:
      return refuse();
  }
}

std::optional<Reassembly::Message> Reassembly::refuse() {
  ++malformed_;
  return std::nullopt;
}

std::optional<Reassembly::Message> Reassembly::take_whole(Bytes rest, const Wanted& wanted) {
  const std::string_view channel = channel_at(rest);
  if (channel.empty()) return refuse();
  if (!wanted(channel)) return std::nullopt;
  return Message{channel, rest.subspan(channel.size() + 1)};
}

std::optional<Reassembly::Message> Reassembly::take_fragment(Bytes datagram, std::uint64_t sender,
                                                             const Wanted& wanted) {
  if (datagram.size() < fragment_header) return refuse();
  const std::uint32_t number = big_endian<std::uint32_t>(datagram, 4);
  const std::size_t size = big_endian<std::uint32_t>(datagram, 8),
                    offset = big_endian<std::uint32_t>(datagram, 12);
  const std::size_t fragment = big_endian<std::uint16_t>(datagram, 16),
                    fragments = big_endian<std::uint16_t>(datagram, 18);
  Bytes data = datagram.subspan(fragment_header);
  std::string_view channel;
  if (fragment == 0) {
    channel = channel_at(data);
    if (channel.empty()) return refuse();
    data = data.subspan(channel.size() + 1);
  }
  // std::size_t has 64 bits: no sum of two 32-bit numbers overflows
  static_assert(sizeof(std::size_t) >= 8);
  if (fragment >= fragments || offset + data.size() > size || fragments > size + 1) return refuse();

  Place partial = find(sender);
  if (partial != partials_.end() &&
      (partial->number != number || partial->bytes.size() != size || partial->parts.size() != fragments)) {
    drop(partial);  // its sender has gone on to the next message
    partial = partials_.end();
  }
  if (partial == partials_.end()) {
    // only the first fragment names the channel; without it the message is dropped, as by LCM
    if (fragment != 0 || !wanted(channel)) return std::nullopt;
    if (size + sizeof(Part) * fragments > options_.max_message) {
      ++incomplete_;
      return std::nullopt;
    }
    partial = begin_message(sender, number, channel, size, fragments);
  }
  Part& part = partial->parts[fragment];
  if (part.there) return std::nullopt;
  part = {static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(data.size()), true};
  std::copy(data.begin(), data.end(), partial->bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  if (--partial->missing > 0) return std::nullopt;
  held_ -= partial->memory();
  complete_ = std::move(*partial);
  partials_.erase(partial);
  if (!complete_.without_holes()) return refuse();
  return Message{complete_.channel, complete_.bytes};
}

Reassembly::Place Reassembly::begin_message(std::uint64_t sender, std::uint32_t number,
                                            std::string_view channel, std::size_t size,
                                            std::size_t fragments) {
  const std::size_t memory = size + sizeof(Part) * fragments;
  while (!partials_.empty() &&
         (partials_.size() >= options_.max_senders || held_ + memory > options_.max_total))
    drop(partials_.begin());
  held_ += memory;
  EGOCAL_CHECK(held_ <= std::max(options_.max_total, memory), "memory of incomplete messages is bounded");
  Partial& partial = partials_.emplace_back();
  partial.sender = sender;
  partial.number = number;
  partial.channel = channel;
  partial.bytes.resize(size);
  partial.parts.resize(fragments);
  partial.missing = fragments;
  return std::prev(partials_.end());
}

void Reassembly::drop(Place partial) {
  ++incomplete_;
  held_ -= partial->memory();
  partials_.erase(partial);
}

bool Reassembly::Partial::without_holes() const {
  std::vector<Part> sorted = parts;
  std::sort(sorted.begin(), sorted.end(), [](const Part& x, const Part& y) {
    return std::pair(x.offset, x.size) < std::pair(y.offset, y.size);
  });
  std::size_t end = 0;
  for (const Part& part : sorted) {
    if (part.offset != end) return false;
    end += part.size;
  }
  return end == bytes.size();
}

Reassembly::Place Reassembly::find(std::uint64_t sender) {
  return std::find_if(partials_.begin(), partials_.end(),
                      [sender](const Partial& partial) { return partial.sender == sender; });
}

}  // namespace egocal::bus
