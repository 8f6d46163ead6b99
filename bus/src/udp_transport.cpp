// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "udp_transport.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "egocal/bus/datagrams.hpp"
#include "egocal/error.hpp"
#include "memory_transport.hpp"

namespace egocal::bus {

namespace {

constexpr std::size_t datagram_size = 65536;  // bytes: no UDP datagram is longer
/// Datagrams fetched by one system call, so that a flood costs less than a call each.
constexpr std::size_t datagrams_at_once = 16;
/// Time to wait for a full queue of the network card [us]. After it the network counts as away.
constexpr long send_timeout_us = 100'000;

const char* const remedy =
    "; to allow it on this host: sudo ip link set lo up multicast on; sudo ip route add 224.0.0.0/4 dev lo";

class Socket {
 public:
  Socket() = default;
  explicit Socket(int flags) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | flags, 0)) {
    if (fd_ < 0) throw Error(std::string("cannot open a UDP socket: ") + std::strerror(errno));
  }
  ~Socket() { reset(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    reset();
    fd_ = std::exchange(other.fd_, -1);
    return *this;
  }
  int fd() const { return fd_; }

  template <class Value>
  bool set(int level, int name, const Value& value) {
    return setsockopt(fd_, level, name, &value, sizeof value) == 0;
  }

 private:
  void reset() {
    if (fd_ >= 0) close(fd_);
  }
  int fd_ = -1;
};

std::int64_t realtime_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

class UdpTransport final : public Transport {
 public:
  UdpTransport(const LcmUrl& url, const Clock& clock) : url_(url), clock_(clock), sender_(0) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(url.port);
    inet_pton(AF_INET, url.group.c_str(), &to_.sin_addr);
    sender_.set(IPPROTO_IP, IP_MULTICAST_TTL, static_cast<unsigned char>(url.ttl));
    sender_.set(IPPROTO_IP, IP_MULTICAST_LOOP, static_cast<unsigned char>(1));
    sender_.set(SOL_SOCKET, SO_SNDTIMEO, timeval{0, send_timeout_us});
    open_receiver();
    empty_us_ = clock_.mono_us();
  }

  SendStatus send(std::string_view channel, Bytes bytes) override {
    if (!fits_datagrams(channel, bytes)) return SendStatus::too_large;
    const bool sent = for_each_datagram(channel, bytes, number_++, [this](const Datagram& datagram) {
      const Bytes header = datagram.header();
      std::array<iovec, 2> parts{
          iovec{const_cast<std::byte*>(header.data()), header.size()},
          iovec{const_cast<std::byte*>(datagram.payload.data()), datagram.payload.size()}};
      msghdr message{};
      message.msg_name = &to_;
      message.msg_namelen = sizeof to_;
      message.msg_iov = parts.data();
      message.msg_iovlen = parts.size();
      ssize_t result = -1;
      do result = sendmsg(sender_.fd(), &message, MSG_NOSIGNAL);
      while (result < 0 && errno == EINTR);
      return result >= 0;
    });
    send_error_ = sent ? 0 : errno;
    return sent ? SendStatus::sent : SendStatus::no_network;
  }

  bool receive(const Wanted& wanted, Received& message) override {
    for (;;) {
      while (next_ < fetched_) {
        const std::size_t i = next_++;
        if (headers_[i].msg_hdr.msg_flags & MSG_TRUNC) continue;
        const Bytes datagram(storage_.data() + i * datagram_size, headers_[i].msg_len);
        const auto found = reassembly_.take(datagram, sender_number(from_[i]), wanted);
        if (!found) continue;
        message = {found->channel, found->bytes, arrival_us(headers_[i].msg_hdr)};
        return true;
      }
      if (!fetch()) return false;
    }
  }

  int fd() const override { return receiver_.fd(); }
  bool ready() const override { return next_ < fetched_; }

  /// Joins again. That fails with EADDRINUSE while the membership exists, and joins on the new interface if
  /// the route has moved.
  void check_network() override {
    ip_mreqn group{};
    group.imr_multiaddr = to_.sin_addr;
    if (receiver_.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, group) || errno == EADDRINUSE) {
      join_error_ = 0;
    } else if (errno == ENOBUFS) {  // memberships of interfaces that are gone: start again
      open_receiver();
      join_error_ = receiver_.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, group) ? 0 : errno;
    } else {
      join_error_ = errno;
    }
    if (send_error_ != 0) probe_route();
  }

  std::string network_error() const override {
    // joining reports "No such device" if there is no route; the error of sending is clearer
    const int error = join_error_ == ENODEV ? ENETUNREACH : join_error_ != 0 ? join_error_ : send_error_;
    return error == 0 ? std::string{}
                      : "no multicast to " + url_.group + ": " + std::strerror(error) + remedy;
  }

  TransportCounts counts() const override {
    return {reassembly_.malformed(), reassembly_.incomplete(), overflow_before_ + overflow_};
  }

 private:
  void open_receiver() {
    Socket socket(SOCK_NONBLOCK);
    socket.set(SOL_SOCKET, SO_REUSEADDR, 1);
    // SO_RCVBUFFORCE needs a capability that few processes have; SO_RCVBUF gives up to net.core.rmem_max
    if (!socket.set(SOL_SOCKET, SO_RCVBUFFORCE, url_.receive_buffer))
      socket.set(SOL_SOCKET, SO_RCVBUF, url_.receive_buffer);
    socket.set(SOL_SOCKET, SO_TIMESTAMPNS, 1);
    socket.set(SOL_SOCKET, SO_RXQ_OVFL, 1);
    socket.set(IPPROTO_IP, IP_MULTICAST_ALL, 0);
    // bound to the group and not to any address, so that other traffic to this port of the host does not
    // arrive here
    if (bind(socket.fd(), reinterpret_cast<const sockaddr*>(&to_), sizeof to_) != 0)
      throw Error("cannot listen on UDP " + url_.group + ":" + std::to_string(url_.port) + ": " +
                  std::strerror(errno));
    receiver_ = std::move(socket);
    overflow_before_ += overflow_;
    overflow_ = 0;
    next_ = fetched_ = 0;
  }

  /// Notices a route that has come back, even if nothing is sent meanwhile.
  void probe_route() {
    const Socket probe(0);
    if (connect(probe.fd(), reinterpret_cast<const sockaddr*>(&to_), sizeof to_) == 0) send_error_ = 0;
  }

  /// Fetches datagrams that wait. False: there are none.
  bool fetch() {
    std::array<iovec, datagrams_at_once> parts;
    for (std::size_t i = 0; i < datagrams_at_once; ++i) {
      parts[i] = {storage_.data() + i * datagram_size, datagram_size};
      msghdr& header = headers_[i].msg_hdr;
      header = {};
      header.msg_name = &from_[i];
      header.msg_namelen = sizeof from_[i];
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_control = control_[i].bytes;
      header.msg_controllen = sizeof control_[i].bytes;
    }
    next_ = fetched_ = 0;
    const std::int64_t mono_us = clock_.mono_us();
    int count = -1;
    do count = recvmmsg(receiver_.fd(), headers_.data(), datagrams_at_once, 0, nullptr);
    while (count < 0 && errno == EINTR);
    fetched_mono_us_ = clock_.mono_us();
    realtime_ns_ = realtime_ns();
    not_before_us_ = empty_us_;
    if (count < static_cast<int>(datagrams_at_once)) empty_us_ = mono_us;
    if (count <= 0) return false;
    fetched_ = static_cast<std::size_t>(count);
    return true;
  }

  /// Time of arrival. The kernel stamps by the wall clock, which may be set at any moment; but no message
  /// arrived before the socket was last found empty.
  std::int64_t arrival_us(msghdr& header) {
    std::int64_t age_us = 0;
    for (cmsghdr* entry = CMSG_FIRSTHDR(&header); entry; entry = CMSG_NXTHDR(&header, entry)) {
      if (entry->cmsg_level != SOL_SOCKET) continue;
      if (entry->cmsg_type == SCM_TIMESTAMPNS) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(entry), sizeof stamp);
        age_us = (realtime_ns_ - (std::int64_t{1'000'000'000} * stamp.tv_sec + stamp.tv_nsec)) / 1000;
      } else if (entry->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t dropped = 0;
        std::memcpy(&dropped, CMSG_DATA(entry), sizeof dropped);
        overflow_ = std::max<std::int64_t>(overflow_, dropped);
      }
    }
    return std::clamp(fetched_mono_us_ - age_us, not_before_us_, fetched_mono_us_);
  }

  static std::uint64_t sender_number(const sockaddr_in& from) {
    return std::uint64_t{from.sin_addr.s_addr} << 16 | from.sin_port;
  }

  struct alignas(cmsghdr) Control {
    char bytes[128];
  };

  LcmUrl url_;
  const Clock& clock_;
  sockaddr_in to_{};
  Socket sender_, receiver_;
  std::uint32_t number_ = 0;
  int send_error_ = 0, join_error_ = ENODEV;
  Reassembly reassembly_;
  std::vector<std::byte> storage_ = std::vector<std::byte>(datagrams_at_once * datagram_size);
  std::array<mmsghdr, datagrams_at_once> headers_{};
  std::array<sockaddr_in, datagrams_at_once> from_{};
  std::array<Control, datagrams_at_once> control_{};
  std::size_t next_ = 0, fetched_ = 0;
  std::int64_t fetched_mono_us_ = 0, realtime_ns_ = 0;
  std::int64_t empty_us_ = 0;       ///< all that had come by then has been fetched
  std::int64_t not_before_us_ = 0;  ///< the same, of the fetch before
  std::int64_t overflow_before_ = 0, overflow_ = 0;
};

}  // namespace

std::unique_ptr<Transport> open_udp_transport(const LcmUrl& url, const Clock& clock) {
  return std::make_unique<UdpTransport>(url, clock);
}

std::unique_ptr<Transport> open_transport(const LcmUrl& url, const Clock& clock) {
  auto transport = url.memory ? open_memory_transport(clock) : open_udp_transport(url, clock);
  transport->check_network();
  return transport;
}

}  // namespace egocal::bus
