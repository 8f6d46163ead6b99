// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/experiment.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "commands/source_options.hpp"
#include "experiments/figure.hpp"
#include "experiments/globality.hpp"
#include "experiments/noise_slopes.hpp"
#include "experiments/online.hpp"
#include "experiments/paper.hpp"

namespace egocal::tools {

namespace {

/// A progress bar on standard error, on a terminal.
class ProgressBar {
 public:
  void operator()(double part) {
    const int percent = static_cast<int>(100 * part);
    if (!terminal_ || percent == percent_) return;
    percent_ = percent;
    fmt::print(stderr, "\r[{:<40}] {:3} %{}", std::string(static_cast<std::size_t>(percent) * 40 / 100, '#'),
               percent, percent == 100 ? "\n" : "");
    std::fflush(stderr);
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  int percent_ = -1;
};

template <typename Points>
void finish(const Points& points, const std::string& directory, const std::string& name) {
  for (const std::string& file : write_figure(directory, name, csv(points), panels(points)))
    fmt::print("{}\n", file);
}

void add_noise(cli::App experiment) {
  struct Options {
    NoiseOptions noise;
    std::string out = ".";
  };
  const auto options = std::make_shared<Options>();
  cli::App command = experiment.add_subcommand(
      "noise", "Fig. 4: error over the number of motion pairs for several noise levels");
  command.add_option("--levels", options->noise.levels, "noise relative to the mean motion")
      .comma_separated()
      .show_default()
      .check(cli::Check::range(0.0, 10.0));
  command.add_option("--pairs", options->noise.most_pairs, "most motion pairs")
      .show_default()
      .check(cli::Check::range(2, 1000000));
  command.add_option("--sizes", options->noise.sizes, "how many numbers of pairs, from 10 to the most")
      .show_default()
      .check(cli::Check::range(1, 1000));
  command.add_option("--sensors", options->noise.sensors, "poses of sensor b, 2 to 8 m away")
      .show_default()
      .check(cli::Check::range(1, 1000));
  command.add_option("--repeats", options->noise.repeats, "runs of each")
      .show_default()
      .check(cli::Check::range(1, 1000));
  command
      .add_option("--roughness", options->noise.roughness,
                  "amplitude of the surface [m]; 1.8: 0.1 rad from pose to pose, as in V-A")
      .show_default()
      .check(cli::Check::range(0.0, 1e3));
  command.add_flag("--mixed", options->noise.mixed,
                   "a number of pairs is a sample of the whole drive, not its beginning");
  command.add_option("--seed", options->noise.seed, "of the random numbers").show_default();
  command.add_output("--out", options->out, "folder for the CSV and the SVG pictures").show_default();
  command.callback([options] {
    const std::vector<NoisePoint> points = noise_experiment(options->noise, ProgressBar{});
    finish(points, options->out, "noise");
    fmt::print("\nexponents of n, mean of all runs where n > 100:\n\n{}", markdown(slopes(points)));
  });
}

void add_online(cli::App experiment) {
  struct Options {
    Source source;
    std::size_t frames = 150;
    double t_no_fail = 5;
    std::string fast = "sqp", global = "dual";
    std::string out = ".";
  };
  const auto options = std::make_shared<Options>();
  cli::App command = experiment.add_subcommand(
      "online", "Fig. 6: Algorithm 1 frame by frame; planar where both ground planes are given");
  add_source_options(command, options->source);
  command.add_option("--frames", options->frames, "motion pairs")
      .show_default()
      .check(cli::Check::range(1, 10'000'000));
  command
      .add_option("--t-no-fail", options->t_no_fail,
                  "time that the fast solution must have been verified for [s]")
      .show_default()
      .check(cli::Check::not_negative());
  command.add_option("--fast", options->fast, "sqp or slsqp")
      .show_default()
      .check(cli::Check::one_of({"sqp", "slsqp"}));
  command.add_option("--global", options->global, "dual or sdp")
      .show_default()
      .check(cli::Check::one_of({"dual", "sdp"}));
  command.add_output("--out", options->out, "folder for the CSV and the SVG pictures").show_default();
  command.callback([options] {
    const DataSet data = load_warning(options->source);
    OnlineOptions online;
    online.t_no_fail = options->t_no_fail;
    online.fast = method_from_name(options->fast).value_or(Method::sqp);
    online.global = method_from_name(options->global).value_or(Method::dual);
    const Mode mode = data.plane_a ? Mode::planar : Mode::spatial;
    finish(online_experiment(data, mode, options->frames, online, ProgressBar{}), options->out, "online");
  });
}

void add_globality(cli::App experiment) {
  struct Options {
    Source source;
    GlobalityOptions globality;
    std::string out = ".";
  };
  const auto options = std::make_shared<Options>();
  cli::App command = experiment.add_subcommand(
      "globality", "section V-F: the optimum falsified by growing amounts, and its duality gap");
  add_source_options(command, options->source);
  command.add_option("--directions", options->globality.directions, "of each amount")
      .show_default()
      .check(cli::Check::range(1, 100000));
  command.add_output("--out", options->out, "folder for the CSV and the SVG pictures").show_default();
  command.callback([options] {
    finish(globality_experiment(load_warning(options->source), options->globality), options->out,
           "globality");
  });
}

void add_paper(cli::App experiment) {
  const auto options = std::make_shared<PaperOptions>();
  cli::App command = experiment.add_subcommand(
      "paper", "every table and figure of the paper, on one page beside the printed numbers");
  command.add_option(
      "--data", options->data,
      "folder with kitti_05, kitti_07, kitti_ground_planes (docs/paper.md); without it: simulated drives");
  command
      .add_output("--out", options->out,
                  "folder for the page, the figures and their numbers; an interrupted run continues")
      .required();
  command.add_flag("--paper", options->full, "Fig. 4 at the paper's size: 224,448 optimisations");
  command.add_option("--repeats", options->repeats, "of each method, for its time")
      .show_default()
      .check(cli::Check::range(1, 1000));
  command.callback([options] {
    ProgressBar progress;
    fmt::print("{}\n", reproduce_paper(*options, [&](const std::string&, double part) { progress(part); }));
  });
}

}  // namespace

void add_experiment(cli::App program) {
  cli::App experiment =
      program.add_subcommand("experiment", "the paper's experiments, as numbers and pictures");
  experiment.require_subcommand();
  add_noise(experiment);
  add_online(experiment);
  add_globality(experiment);
  add_paper(experiment);
}

}  // namespace egocal::tools
