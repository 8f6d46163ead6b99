// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/glue.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/online/algorithm1.hpp"

namespace egocal::tools {

namespace {

struct Options {
  std::string log, rig, url, pair, format = "yaml", out;
  double timeout = 5;
};

/// Of all answers heard for each pair the one that counts.
class Answers {
 public:
  void hear(const calibration_t& message) {
    const bus::Checked<Answer> answer = bus::to_answer(message);
    if (!answer) return;
    const AnswerRank claim{message.session, message.seq, answer.value->certificate.optimality,
                           answer.value->certificate.cost};
    const auto [entry, fresh] = best_.try_emplace({message.sensor_a, message.sensor_b}, Best{message, claim});
    if (!fresh && outranks(claim, entry->second.claim)) entry->second = {message, claim};
  }
  bool has(const std::string& pair) const { return find(pair) != best_.end(); }

  /// Throws Error where there is none, or more than one pair and no choice was made.
  NamedExtrinsic chosen(const std::string& pair) const {
    const auto entry = find(pair);
    if (entry == best_.end())
      throw Error(best_.empty() ? "export: there is no answer"
                                : "export: there is no answer for the pair " + pair);
    if (pair.empty() && best_.size() > 1) {
      std::string known;
      for (const auto& [names, best] : best_)
        known += (known.empty() ? "" : ", ") + names.first + "," + names.second;
      throw UsageError("--pair: several pairs have answers, choose one of: " + known);
    }
    const calibration_t& message = entry->second.message;
    const Answer answer = *bus::to_answer(message).value;
    return {entry->first.first,  entry->first.second, to_pose(answer.T_a_b),
            message.status == 0, message.pairs,       answer.observability.stddev};
  }

 private:
  struct Best {
    calibration_t message;
    AnswerRank claim;
  };
  using Map = std::map<std::pair<std::string, std::string>, Best>;
  Map::const_iterator find(const std::string& pair) const {
    return std::find_if(best_.begin(), best_.end(), [&](const auto& entry) {
      return pair.empty() || entry.first.first + "," + entry.first.second == pair;
    });
  }
  Map best_;
};

Answers recorded(const Options& options) {
  Answers answers;
  bus::LogReader log(options.log);
  while (const auto event = log.next()) {
    calibration_t message{};
    if (event->channel.rfind("EGOCAL_CALIBRATION_", 0) == 0 && bus::decode(event->data, message))
      answers.hear(message);
  }
  return answers;
}

/// Whoever solves sends its newest answer again every second.
Answers live(const Options& options) {
  Answers answers;
  const bus::Rig rig = bus::read_rig(options.rig);
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  for (const bus::PairConfig& pair : rig.pairs)
    loop.subscribe<calibration_t>(
        bus::calibration_channel(pair.a, pair.b),
        [&answers](const calibration_t& message, const bus::Arrival&) { answers.hear(message); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.timeout);
  while (!answers.has(options.pair) && std::chrono::steady_clock::now() < end)
    if (!loop.run_once(std::chrono::milliseconds(50))) break;
  return answers;
}

void run(const Options& options) {
  if (options.log.empty() == options.rig.empty()) throw UsageError("export: expected either --log or --rig");
  const NamedExtrinsic extrinsic =
      (options.log.empty() ? live(options) : recorded(options)).chosen(options.pair);
  const std::string text = extrinsic_text(extrinsic, *extrinsic_format_from_name(options.format));
  if (options.out.empty())
    fmt::print("{}", text);
  else
    write_whole_file(options.out, text);
  if (!extrinsic.certified) fmt::print(stderr, "egocal: this answer is not certified\n");
}

}  // namespace

void add_export(cli::App program) {
  const auto options = std::make_shared<Options>();
  cli::App command = program.add_subcommand("export", "export the current answer (YAML, ROS, URDF, ...)");
  command.add_option("--rig", options->rig, "rig file: takes the answer from the running processes");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.add_option("--log", options->log, "LCM log of a session: takes its last answer");
  command.add_option("--pair", options->pair, "A,B where there are several");
  command.add_option("--format", options->format)
      .check(cli::Check::one_of(extrinsic_format_names()))
      .show_default();
  command.add_option("--out", options->out, "file, written whole or not at all; standard output without it");
  command.add_option("--timeout", options->timeout, "waits so long for an answer [s]")
      .check(cli::Check::not_negative())
      .show_default();
  command.callback([options] { run(*options); });
}

}  // namespace egocal::tools
