// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "egocal/degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

// An answer in words and numbers for people: degrees and centimetres.

inline constexpr double centimetres_per_metre = 100.0;  // unit

/// What is kept of a text from a sender: its first Model::max_text bytes.
std::string bounded(const std::string& text);
/// Factor from SI units to those shown, by direction (x y z roll pitch yaw).
double scale_of(int direction);
/// Whether the ground planes give this direction: in planar mode, what the motions cannot show.
bool from_ground(const PairState& pair, int direction);
bool shown_by_motion(const Shown& shown, int direction);
/// x y z [m], roll pitch yaw [rad].
std::array<double, 6> components(const Pose& T);
/// The largest of three values, of standard deviations for instance.
double largest(const double* values);
/// The largest standard deviation of x y z [m] (from 0), or of roll pitch yaw [rad] (from 3).
double largest_stddev(const Shown& shown, std::size_t from);

/// "+-0.94", or "plane" where the ground plane gives it.
std::string spread(const PairState& pair, int direction, int decimals, Charset charset);
/// "14.34 cm" or "0.262 deg": as many decimals as the size deserves.
std::string centimetres(double metres, Charset charset);
std::string degrees(double radians, Charset charset);
/// "z yaw": what the motions do not show; empty where they show everything.
std::string missing_directions(const PairState& pair);
std::string latency(const calibration_t& answer, Charset charset);
std::string solve_time(const calibration_t& answer, Charset charset);
std::string verify_time(const calibration_t& answer, Charset charset);

/// How long ago the newest motion of a solver's answer came: "12 s". Solvers repeat the same answer
/// every second.
std::string answer_age(const PairState& pair, const SolverTrack& solver, Now now);

struct Label {
  std::string text;
  Style style;
};
/// "good", "contradictory": whether the answer can be used, with a mark, at most 15 cells. Until there is a
/// verdict: how far the pair is.
Label verdict_of(const PairState& pair, Charset charset);
/// Whether what came since the verdict was not judged in time, or has moved the answer away from the one that
/// was judged.
bool verdict_is_old(const PairState& pair);
/// "optimal (proven)" or why not: whether another extrinsic explains the same motions better.
Label proof_of(const calibration_t& answer);
/// What to do about it, or why, in one line: the first finding with its cure, else the goal, else the reason.
Label advice_of(const PairState& pair);
/// "The clocks drift. Cure: ...".
std::string with_cure(const Finding& finding);
/// Why there is no answer yet.
std::string unanswered_text(const PairState& pair, Charset charset);
/// "no new motion for 12 s: camera sends nothing".
std::string standing_text(const PairState& pair);
/// "done", "weak: z yaw, about 2 min more; Take a ramp": empty without a goal.
std::string goal_text(const Diagnosis& diagnosis);
/// "0.12 deg, 1.3 cm (0.8 % of the way) a motion of 1.2 s, ..."; empty where it was not measured.
std::string fit_text(const PairVerdict& verdict, Charset charset);
/// "0.37012 ±0.0004 of camera, proven": what its lengths are multiplied by, or why that is not known.
Label scale_text(const bus::CheckedScale& scale, Charset charset);
/// Whether the answer is of motions of many strides; the problem's stride is the best single one, and not in
/// force.
bool sums_strides(const problem_t& problem);
/// "stride 4", "many strides".
std::string stride_text(const problem_t& problem);
std::string pair_title(const PairState& pair, Charset charset, std::size_t max = 28);
/// "a → b", at most this many cells wide: names that do not fit are cut in the middle.
std::string pair_in(const std::string& a, const std::string& b, int cells, Charset charset);
/// "fast" for "egocal-fast".
std::string short_solver(const std::string& name, std::size_t max = 12);
Style solver_style(Role role);

}  // namespace egocal::monitor
