// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A bad network between two LCM URLs, for tests.
#include "support/lossy_relay.hpp"
#include "egocal/cli/cli.hpp"

#include <cstdio>

#include "egocal/bus/loop.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string from, to;
  std::vector<std::string> channels;
  test::Losses losses;
  std::uint64_t seed = 1;
  cli::Program app(
      "egocal_lossy_relay",
      "Hands messages on from one LCM URL to another: loses, doubles, reorders and damages some.");
  app.footer("Prints its exact counts on SIGINT and SIGTERM.");
  app.add_option("--from", from, "LCM URL").required();
  app.add_option("--to", to, "LCM URL").required();
  app.add_option("--channel", channels, "name; one or more").required();
  app.add_option("--drop", losses.dropped, "probability").show_default();
  app.add_option("--double", losses.doubled, "probability").show_default();
  app.add_option("--reorder", losses.reordered, "probability").show_default();
  app.add_option("--flip", losses.flipped, "probability of one wrong bit in a message").show_default();
  app.add_option("--seed", seed).show_default();
  if (const auto code = app.parse(argc, argv)) return *code;
  try {
    bus::Loop in(from), out(to, bus::LoopOptions{.handle_signals = false});
    test::LossyRelay relay(losses, seed, [&](const std::string& channel, bus::Bytes bytes) {
      out.publish_bytes(channel, bytes);
    });
    for (const std::string& channel : channels)
      in.subscribe_bytes(
          channel, [&](const bus::Arrival& arrival) { relay.take(arrival.channel, arrival.bytes); }, 4096);
    in.run();
    relay.flush();
    const test::RelayCounts& counts = relay.counts();
    std::printf("in %lld out %lld dropped %lld doubled %lld reordered %lld flipped %lld\n",
                static_cast<long long>(counts.in), static_cast<long long>(counts.out),
                static_cast<long long>(counts.dropped), static_cast<long long>(counts.doubled),
                static_cast<long long>(counts.reordered), static_cast<long long>(counts.flipped));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal_lossy_relay: %s\n", error.what());
    return 1;
  }
}
