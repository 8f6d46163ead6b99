// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "answers/exported_answer.hpp"
#include "answers/gathered_answers.hpp"
#include "arguments.hpp"
#include "commands/commands.hpp"
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
  const WantedAnswers wanted{options.pair, options.all};
  const std::optional<GatheredAnswers> found =
      live ? heard_answers(options.rig, options.url, wanted, options.timeout)
           : answers_of_log(options.log, wanted);
  if (!found) throw cli::Exit{1};
  for (const auto& [reason, count] : found->answers.refused())
    say(fmt::format("egocal: warning: {} refused: {}", counted(static_cast<std::uint64_t>(count), "answer"),
                    reason));
  std::vector<NamedExtrinsic> extrinsics;
  bool refused = false;
  for (const PairName& pair : found->pairs)
    if (found->answers.best(pair)) {
      refused = refused || !may_be_used(pair, found->answers, live);
      extrinsics.push_back(exported_answer(pair, *found, live));
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
  command.add_flag("--all", options->all, "all pairs of the rig as one tree: " + tree_format_names())
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
