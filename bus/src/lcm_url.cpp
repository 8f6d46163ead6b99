// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/lcm_url.hpp"

#include <arpa/inet.h>

#include <charconv>
#include <string_view>

#include "egocal/bus/plausible.hpp"
#include "egocal/error.hpp"

namespace egocal::bus {

namespace {

[[noreturn]] void refuse(const std::string& url, const std::string& problem) {
  throw Error("LCM URL '" + printable(url, 200) + "': " + problem);
}

long whole_number(const std::string& url, std::string_view text, const std::string& what, long least,
                  long most) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most)
    refuse(url,
           what + ": expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

void read_option(const std::string& url, std::string_view option, LcmUrl& out) {
  const std::size_t equals = option.find('=');
  const std::string_view key = option.substr(0, equals);
  const std::string_view value =
      equals == std::string_view::npos ? std::string_view{} : option.substr(equals + 1);
  if (key == "ttl")
    out.ttl = static_cast<int>(whole_number(url, value, "ttl", 0, 255));
  else if (key == "recv_buf_size")
    out.receive_buffer = static_cast<int>(whole_number(url, value, "recv_buf_size", 1, 1 << 30));
  else
    refuse(url, "unknown option '" + printable(std::string(key), 40) + "'; expected ttl or recv_buf_size");
}

}  // namespace

LcmUrl parse_lcm_url(const std::string& url) {
  LcmUrl out;
  if (url == "memq://") {
    out.memory = true;
    return out;
  }
  constexpr std::string_view scheme = "udpm://";
  if (url.rfind(scheme, 0) != 0) refuse(url, "expected udpm://GROUP:PORT?ttl=N");
  const std::string_view rest = std::string_view(url).substr(scheme.size());
  const std::string_view place = rest.substr(0, rest.find('?'));
  const std::size_t colon = place.find(':');
  if (const std::string_view group = place.substr(0, colon); !group.empty()) out.group = group;
  in_addr address{};
  if (inet_pton(AF_INET, out.group.c_str(), &address) != 1)
    refuse(url, "'" + printable(out.group, 60) + "' is not an IPv4 address");
  if (!IN_MULTICAST(ntohl(address.s_addr)))
    refuse(url, "'" + out.group + "' is not a multicast address (224.0.0.0 to 239.255.255.255)");
  if (colon != std::string_view::npos)
    out.port = static_cast<std::uint16_t>(whole_number(url, place.substr(colon + 1), "port", 1, 65535));
  if (place.size() < rest.size()) {
    std::string_view options = rest.substr(place.size() + 1);
    while (!options.empty()) {
      const std::size_t end = options.find('&');
      if (const std::string_view option = options.substr(0, end); !option.empty())
        read_option(url, option, out);
      options = end == std::string_view::npos ? std::string_view{} : options.substr(end + 1);
    }
  }
  return out;
}

}  // namespace egocal::bus
