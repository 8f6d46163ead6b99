// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answers/gathered_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "arguments.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/pair_messages.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/printable.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

std::string listed(const std::vector<PairName>& pairs) {
  std::string all;
  for (const PairName& pair : pairs) all += (all.empty() ? "" : " ") + text(pair);
  return all;
}

/// The pair that was asked for, or the only one. Throws UsageError naming those that are there.
PairName chosen(const std::string& wanted, const std::vector<PairName>& pairs) {
  if (wanted.empty() && pairs.size() == 1) return pairs.front();
  for (const PairName& pair : pairs)
    if (text(pair) == wanted) return pair;
  throw UsageError(wanted.empty() ? "--pair: there are several, choose one of: " + listed(pairs)
                                  : "--pair: there is no " + printable(wanted, 100) +
                                        ", choose one of: " + listed(pairs));
}

}  // namespace

GatheredAnswers answers_of_log(const std::string& log, const WantedAnswers& wanted) {
  GatheredAnswers found{{}, recorded_answers(log)};
  for (const auto& [pair, best] : found.answers.all()) found.pairs.push_back(pair);
  if (found.pairs.empty()) throw Error("export: there is no answer in " + log);
  if (!wanted.all) found.pairs = {chosen(wanted.pair, found.pairs)};
  return found;
}

std::optional<GatheredAnswers> heard_answers(const std::string& rig_file, const std::string& url,
                                             const WantedAnswers& wanted, double timeout) {
  const bus::Rig rig = bus::read_rig(rig_file);
  std::vector<PairName> pairs;
  for (const bus::PairConfig& pair : rig.pairs) pairs.emplace_back(pair.a, pair.b);
  GatheredAnswers found{wanted.all ? pairs : std::vector<PairName>{chosen(wanted.pair, pairs)}, {}};
  found.answers.expect_scales(rig);
  for (const bus::PairConfig& pair : rig.pairs)
    if (pair.nominal) found.with_nominal.emplace(pair.a, pair.b);
  bus::Loop loop(url.empty() ? rig.lcm_url : url);
  for (const auto& [a, b] : found.pairs)
    bus::subscribe_pair(loop, a, b,
                        [&](const auto& message, const bus::Arrival&) { found.answers.hear(message); });
  // verdicts are sent again every second, as heartbeats are: without a diagnosis none is waited for
  bool judged_here = false;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    judged_here = judged_here || (status.role == bus::role_name(bus::Role::diagnosis) &&
                                  status.state != bus::state_name(bus::State::ended));
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  const auto heard_all = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
  const auto done = [&] {
    const bool waits = judged_here || std::chrono::steady_clock::now() < heard_all;
    return std::all_of(found.pairs.begin(), found.pairs.end(), [&](const PairName& pair) {
      return found.answers.certified(pair) && found.answers.answered_to_the_end(pair) &&
             (!waits || (found.answers.diagnosis(pair) && !found.answers.departure(pair)));
    });
  };
  while (!done() && std::chrono::steady_clock::now() < end)
    if (!loop.run_once(std::chrono::milliseconds(50))) return std::nullopt;
  for (const auto& [channel, count] : loop.undecodable())
    say(fmt::format("egocal: warning: {}: {} refused: not decodable, or of another pair",
                    printable(channel, 63), counted(static_cast<std::uint64_t>(count), "message")));
  return found;
}

}  // namespace egocal::tools
