// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <set>
#include <vector>

#include "answers/answers.hpp"
#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/bus/backing.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/pair_messages.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/io/extrinsic_tree.hpp"
#include "egocal/io/whole_file.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct ExportOptions {
  std::string log, rig, url, pair, format = "yaml", out;
  double timeout = 5;
  bool all = false;
};

/// Where more of the drive than this has no verdict or no answer, a warning is due [s]: a pair alone is
/// judged every two seconds.
constexpr double longest_behind = 10;

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
                                  : "--pair: there is no " + bus::printable(wanted, 100) +
                                        ", choose one of: " + listed(pairs));
}

struct Found {
  std::vector<PairName> pairs;  ///< the one that was asked for, or all of them
  Answers answers;
  std::set<PairName> with_nominal{};  ///< as the rig file says, for answers whose problem is not received
};

Found recorded(const ExportOptions& options) {
  Found found{{}, recorded_answers(options.log)};
  for (const auto& [pair, best] : found.answers.all()) found.pairs.push_back(pair);
  if (found.pairs.empty()) throw Error("export: there is no answer in " + options.log);
  if (!options.all) found.pairs = {chosen(options.pair, found.pairs)};
  return found;
}

/// Listens for answers. Solvers send their newest answer, and pairing its problem, again every second. What
/// is certified for a problem on the bus cannot be outdone but by newer problems; anything less is waited
/// with until the end.
Found heard(const ExportOptions& options) {
  const bus::Rig rig = bus::read_rig(options.rig);
  std::vector<PairName> pairs;
  for (const bus::PairConfig& pair : rig.pairs) pairs.emplace_back(pair.a, pair.b);
  Found found{options.all ? pairs : std::vector<PairName>{chosen(options.pair, pairs)}, {}};
  found.answers.expect_scales(rig);
  for (const bus::PairConfig& pair : rig.pairs)
    if (pair.nominal) found.with_nominal.emplace(pair.a, pair.b);
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  for (const auto& [a, b] : found.pairs)
    bus::subscribe_pair(loop, a, b,
                        [&](const auto& message, const bus::Arrival&) { found.answers.hear(message); });
  // verdicts are sent again every second, as heartbeats are: without a diagnosis none is waited for
  bool judged_here = false;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    judged_here = judged_here || (status.role == bus::role_name(bus::Role::diagnosis) &&
                                  status.state != bus::state_name(bus::State::ended));
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.timeout);
  const auto heard_all = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
  const auto done = [&] {
    const bool waits = judged_here || std::chrono::steady_clock::now() < heard_all;
    return std::all_of(found.pairs.begin(), found.pairs.end(), [&](const PairName& pair) {
      return found.answers.certified(pair) && found.answers.answered_to_the_end(pair) &&
             (!waits || (found.answers.diagnosis(pair) && !found.answers.departure(pair)));
    });
  };
  while (!done() && std::chrono::steady_clock::now() < end)
    if (!loop.run_once(std::chrono::milliseconds(50))) throw cli::Exit{1};
  for (const auto& [channel, count] : loop.undecodable())
    say(fmt::format("egocal: warning: {}: {} refused: not decodable, or of another pair",
                    bus::printable(channel, 63), counted(static_cast<std::uint64_t>(count), "message")));
  return found;
}

/// Whether an answer is current. Live it is where its problem is sent: pairing repeats the problem once a
/// second, and solvers repeat their answer for hours when pairing hangs or is gone. An answer of a log is
/// always current.
bool is_current(const PairName& pair, const Answers& answers, bool live) {
  return !live || (answers.best(pair)->checked.standing == bus::Standing::verified &&
                   answers.seconds_not_answered(pair) <= longest_behind);
}

/// Sets what the verdict makes of an answer, and that it makes nothing of it where it is about another one.
void judge(const PairName& pair, const Answers& answers, NamedExtrinsic& extrinsic) {
  const Diagnosis* const diagnosis = answers.diagnosis(pair);
  if (!diagnosis) return;
  if (const std::optional<bus::Departure> moved = answers.departure(pair)) {
    extrinsic.usable = false;
    extrinsic.reason = bus::in_words(*moved);
    say(fmt::format("egocal: {}: {}. Before: {}", text(pair), extrinsic.reason, verdict_line(*diagnosis)));
    return;
  }
  if (diagnosis->verdict != Verdict::good)
    say(fmt::format("egocal: {}: {}", text(pair), verdict_line(*diagnosis)));
  extrinsic.usable = extrinsic.usable && diagnosis->verdict != Verdict::contradictory;
  extrinsic.verdict = to_string(diagnosis->verdict);
  extrinsic.reason = diagnosis->reason;
}

/// The extrinsic of a pair that has an answer. Warns of what is missing for it to be certified.
NamedExtrinsic named(const PairName& pair, const Found& found, bool live) {
  const Answers& answers = found.answers;
  const Answers::Best& best = *answers.best(pair);
  const bus::CheckedScale* const scale = answers.scale(pair);
  const Answer& answer = best.checked.answer;
  if (best.checked.standing == bus::Standing::unverified)
    say(fmt::format("egocal: warning: {}: this answer could not be verified: its problem was not received{}",
                    text(pair),
                    live ? ", so pairing is silent and the answer may be old; it is marked unusable" : ""));
  else if (!best.certified())
    say(fmt::format("egocal: warning: {}: this answer is not certified", text(pair)));
  if (answers.lacks_scale(pair))
    say(fmt::format(
        "egocal: warning: {}: the scale of this answer could not be verified: it was not received",
        text(pair)));
  if (const double rest = answers.seconds_not_answered(pair); rest > longest_behind)
    say(fmt::format("egocal: warning: {}: the last {:.0f} s of the drive are not in this answer", text(pair),
                    rest));
  if (const double rest = answers.seconds_not_judged(pair).value_or(0); rest > longest_behind)
    say(fmt::format("egocal: warning: {}: the last {:.0f} s of the drive are not judged", text(pair), rest));
  NamedExtrinsic extrinsic{pair.first,
                           pair.second,
                           to_pose(answer.T_a_b),
                           answers.certified(pair),
                           best.message.pairs,
                           answers.observability(pair).stddev};
  extrinsic.usable = is_current(pair, answers, live);
  judge(pair, answers, extrinsic);
  extrinsic.backing = bus::backing_of(best.checked, best.message.method, found.with_nominal.contains(pair),
                                      answers.diagnosis(pair));
  if (const std::string not_shown = not_shown_in_words(extrinsic); !not_shown.empty())
    say(fmt::format("egocal: {}: {}", text(pair), not_shown));
  if (scale)
    extrinsic.scale = NamedScale{scale->sensor, scale->solution.scale, scale->solution.stddev,
                                 scale->verified && scale->solution.certified};
  return extrinsic;
}

/// One extrinsic, or all of a rig as a tree.
std::string text_of(const std::vector<NamedExtrinsic>& extrinsics, const ExportOptions& options) {
  const ExtrinsicFormat format = *extrinsic_format_from_name(options.format);
  if (!options.all) return extrinsic_text(extrinsics.front(), format);
  if (extrinsics.empty()) throw Error("export: there is no answer for any pair");
  const ExtrinsicTree tree = extrinsic_tree(extrinsics);
  for (const NamedExtrinsic& pair : tree.unused)
    say(fmt::format("egocal: note: {},{} closes a loop and is not part of the tree", pair.parent,
                    pair.child));
  return extrinsic_tree_text(tree, format);
}

void run_export(const ExportOptions& options) {
  if (options.log.empty() == options.rig.empty()) throw UsageError("export: expected either --log or --rig");
  const bool live = options.log.empty();
  const Found found = live ? heard(options) : recorded(options);
  for (const auto& [reason, count] : found.answers.refused())
    say(fmt::format("egocal: warning: {} refused: {}", counted(static_cast<std::uint64_t>(count), "answer"),
                    reason));
  std::vector<NamedExtrinsic> extrinsics;
  bool refused = false;
  for (const PairName& pair : found.pairs)
    if (found.answers.best(pair)) {
      const Diagnosis* diagnosis = found.answers.diagnosis(pair);
      refused = refused || (diagnosis && unusable(*diagnosis)) || found.answers.departure(pair) ||
                !is_current(pair, found.answers, live);
      extrinsics.push_back(named(pair, found, live));
    } else if (options.all)
      say(fmt::format("egocal: warning: there is no answer for the pair {}", text(pair)));
    else
      throw Error("export: there is no answer for the pair " + text(pair));
  const std::string content = text_of(extrinsics, options);
  if (options.out.empty())
    fmt::print("{}", content);
  else
    write_whole_file(options.out, content);
  if (refused) throw cli::Exit{not_to_be_used};
}

}  // namespace

void add_export(cli::App program) {
  const auto options = std::make_shared<ExportOptions>();
  cli::App command = program.add_subcommand("export", "export the current answer (YAML, ROS, URDF, ...)");
  const cli::Option rig =
      command.add_option("--rig", options->rig, "rig file: takes the answer from the running processes");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's").needs(rig);
  command.add_option("--log", options->log, "LCM log of a session: takes the answer that counted at its end");
  const cli::Option pair = command.add_option("--pair", options->pair, "A,B where there are several");
  command
      .add_flag("--all", options->all,
                "all pairs of the rig as one tree: urdf, ros, ros-launch, yaml or json")
      .excludes(pair);
  command.add_option("--format", options->format)
      .check(cli::Check::one_of(extrinsic_format_names()))
      .show_default();
  command.add_output("--out", options->out, "file, written whole or not at all; standard output without it");
  command.add_option("--timeout", options->timeout, "waits for a certified answer for at most this time [s]")
      .check(cli::Check::not_negative())
      .show_default()
      .needs(rig);
  command.callback([options] { run_export(*options); });
}

}  // namespace egocal::tools
