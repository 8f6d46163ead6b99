// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Whether the advised manoeuvre shortens the way to a goal: each simulated drive goes on from one time as
// before, and once more with what `goal.next` advises, until the goal is reported as reached. The goal is
// what drives of the kind reach at twice that time. The table of docs/trust_measured.md. Fails where less
// than 80 % of the manoeuvres that are advised halve the time. The end of a drive must be far off: a time to
// the goal that it cuts off cannot be halved.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/random.hpp"
#include "markdown_tables.hpp"
#include "support/simulated_drive.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;
using Eigen::Vector3d;

constexpr double period = 0.1;  ///< between poses [s]
constexpr double degree = std::numbers::pi / 180;
constexpr double manoeuvre_seconds = 16;
constexpr double look_seconds = 2;

struct Kind {
  const char* name;
  Terrain terrain;
  Platform platform;
  double noise;
  double loose;                 ///< the goal of the rotation is this many times what such drives reach
  double speed = 8;             ///< [m/s]
  double slower = 1;            ///< manoeuvres are driven at this part of what they are on a road
  bool of_each_motion = false;  ///< the noise is a part of each motion, not of the mean one
};
/// Noise that is a part of each motion is at least this part of that of the mean one: no odometry is exact at
/// rest.
constexpr double least_noise = 0.2;
constexpr Kind kinds[] = {
    {"road, 1 %", Terrain::rough, Platform::car, 0.01, 1},
    {"road, 3 %", Terrain::rough, Platform::car, 0.03, 1},
    {"nearly flat road, height wanted, 1 %", Terrain::rough, Platform::car, 0.01, 5},
    {"hand-held, mostly about one axis, 2 %", Terrain::flat, Platform::handheld, 0.02, 1},
    {"motorway, 1 %", Terrain::rough, Platform::car, 0.01, 1, 25, 0.3},
    {"motorway, 3 % of each motion", Terrain::rough, Platform::car, 0.03, 1, 25, 0.3, true}};

double wave(double t, double seconds) {
  return std::sin(2 * std::numbers::pi * t / seconds);
}

/// Turning rate [rad/s] and velocity as a part of the usual speed, t seconds into a manoeuvre: of a car
/// forward, left, up, of others in the frame of sensor a. How somebody could drive what the words ask for;
/// the catalogue's own amplitudes are not used.
struct Rates {
  Vector3d turn, travel;
};
using Drive = Rates (*)(double t);

const std::map<std::string, Drive>& drives_of_words() {
  static const std::map<std::string, Drive> drives = {
      {"Drive tight curves both ways: a figure eight, twice.",
       [](double t) {
         return Rates{{0, 0, 20 * degree * (wave(t, 8) > 0 ? 1 : -1)}, {0.6, 0, 0}};
       }},
      {"Drive a slalom.",
       [](double t) {
         return Rates{{0, 0, 10 * degree * wave(t, 4)}, {0.7, 0, 0}};
       }},
      // a bump of 1.6 s in each 3.2 s: up by 4 degrees, level, down
      {"Drive straight over speed bumps or a ramp, five times.",
       [](double t) {
         const double inside = std::fmod(t, 3.2);
         const double pitching = inside < 1.6 ? 4 * degree * 2 * std::numbers::pi / 1.6 *
                                                    std::cos(2 * std::numbers::pi * inside / 1.6)
                                              : 0;
         return Rates{{0, pitching, 0}, {0.4, 0, 0}};
       }},
      // one wheel after the other, from the left and from the right by turns
      {"Drive over a kerb or a ramp at an angle, both ways, five times.",
       [](double t) {
         const double inside = std::fmod(t, 3.2), side = std::fmod(t, 6.4) < 3.2 ? 1 : -1;
         const double rate = inside < 2 ? 3 * degree * std::numbers::pi : 0;
         return Rates{{side * rate * std::sin(std::numbers::pi * inside),
                       rate * std::cos(std::numbers::pi * inside), 0},
                      {0.3, 0, 0}};
       }},
      {"Drive banked curves.",
       [](double t) {
         const double side = wave(t, 16) > 0 ? 1 : -1;
         return Rates{{3 * degree * wave(t, 4), degree * wave(t, 2), side * 10 * degree}, {0.8, 0, 0}};
       }},
      {"Drive straight on for a while.",
       [](double) {
         return Rates{{0, 0, 0}, {1, 0, 0}};
       }},
      {"Tilt the rig about its x axis, both ways, five times.",
       [](double t) {
         return Rates{{40 * degree * wave(t, 3.2), 0, 0}, {0.1, 0.3 * wave(t, 3.2), 0.1}};
       }},
      {"Tilt the rig about its y axis, both ways, five times.",
       [](double t) {
         return Rates{{0, 40 * degree * wave(t, 3.2), 0}, {0.3 * wave(t, 3.2), 0.1, 0.1}};
       }},
      {"Turn the rig about its z axis, both ways, five times.",
       [](double t) {
         return Rates{{0, 0, 40 * degree * wave(t, 3.2)}, {0.3, 0.3 * wave(t, 3.2), 0}};
       }},
      {"Move the rig along all three axes without turning it.",
       [](double t) {
         return Rates{{0, 0, 0}, {wave(t, 4), wave(t, 5.3), wave(t, 6.1)}};
       }},
  };
  return drives;
}

/// One drive in progress, with noise of its own.
class Rig {
 public:
  Rig(const Kind& kind, int poses, std::uint64_t seed)
      : kind_(kind), random_(seed), pairing_(PairingOptions{}) {
    SimulationOptions options;
    options.terrain = kind.terrain;
    options.poses = poses;
    options.seed = seed;
    options.speed = kind.speed;
    if (std::string(kind.name).starts_with("nearly")) options.roughness = 0.01;
    options.T_vehicle_sensor = {Pose{}};
    const Trajectory path = simulate(options).front();
    double turn = 0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      usual_.push_back(inverse(to_pose(path[i].pose)) * to_pose(path[i + 1].pose));
      if (kind.platform != Platform::car) {  // a hand is never steady
        usual_.back().rotation = usual_.back().rotation * rotation_exp(0.003 * random_.normal3());
        usual_.back().translation *= 0.05;
      }
      turn += rotation_log(usual_.back().rotation).norm();
      step_ += usual_.back().translation.norm();
    }
    turn /= static_cast<double>(usual_.size());
    step_ /= static_cast<double>(usual_.size());
    noise_turn_ = kind.noise * turn;
    noise_step_ = kind.noise * step_;
    push();
  }

  /// As before.
  void go_on() { move(usual_[next_++ % usual_.size()]); }
  void manoeuvre(Drive drive, double t) {
    const Rates rates = drive(t);
    const Pose motion{rotation_exp(period * rates.turn), kind_.slower * step_ * rates.travel};
    const Pose T_vehicle_a = testing::T_vehicle_a;
    move(kind_.platform == Platform::car ? motion : T_vehicle_a * motion * inverse(T_vehicle_a));
  }

  double seconds() const { return period * static_cast<double>(count_ - 1); }

  struct Look {
    Goal goal;
    detail::Vector6d error;
  };
  Look look(const GoalOptions& goal) {
    Look result;
    result.error.fill(INFINITY);
    const Problem problem = pairing_.problem();
    if (problem.blocks.empty()) return result;
    const Answer answer = solve(problem, Method::dual);
    Answered answered;
    answered.T_a_b = answer.T_a_b;
    answered.observability = answer.observability;
    answered.problem = pairing_.single_stride_problem();
    answered.minimised = problem;
    answered.stride = pairing_.choice().stride;
    answered.platform = kind_.platform;
    answered.seconds = seconds();
    DiagnosisOptions options;
    options.goal = goal;
    result.goal = diagnose(answered, options).goal.value_or(Goal{});
    result.error = detail::frame_a_difference(truth(), answer.T_a_b);
    return result;
  }

 private:
  static DualQuaternion truth() {
    return to_dual_quaternion(inverse(testing::T_vehicle_a) * testing::T_vehicle_b);
  }
  void move(const Pose& motion) {
    double noise_turn = noise_turn_, noise_step = noise_step_;
    if (kind_.of_each_motion) {
      noise_turn = std::max(least_noise * noise_turn, kind_.noise * rotation_log(motion.rotation).norm());
      noise_step = std::max(least_noise * noise_step, kind_.noise * motion.translation.norm());
    }
    for (auto [pose, T_vehicle] :
         {std::pair(&a_, testing::T_vehicle_a), std::pair(&b_, testing::T_vehicle_b)}) {
      const Pose noise{rotation_exp(noise_turn * random_.normal3()), noise_step * random_.normal3()};
      *pose = *pose * (inverse(T_vehicle) * motion * T_vehicle * noise);
      pose->rotation.normalize();
    }
    push();
  }
  void push() {
    const auto time_us =
        static_cast<std::int64_t>(std::llround(1e6 * period * static_cast<double>(count_++)));
    pairing_.push(Side::a, {time_us, canonical_sign(to_dual_quaternion(a_))});
    pairing_.push(Side::b, {time_us, canonical_sign(to_dual_quaternion(b_))});
  }

  Kind kind_;
  Random random_;
  MotionPairing pairing_;
  std::vector<Pose> usual_;
  std::size_t next_ = 0, count_ = 0;
  double noise_turn_ = 0, noise_step_ = 0, step_ = 0;
  Pose a_, b_;
};

bool is_look(double seconds) {
  return std::fmod(seconds + 0.5 * period, look_seconds) < period;
}

/// Seconds from `begin` on until the goal is reported as reached; limit where it is not.
double seconds_to_goal(const Kind& kind, std::uint64_t seed, const GoalOptions& goal, double begin,
                       double limit, bool advised, std::string* words) {
  Rig rig(kind, static_cast<int>(limit / period) + 1, seed);
  while (rig.seconds() < begin - 0.5 * period) rig.go_on();
  Rig::Look look = rig.look(goal);
  if (look.goal.reached) return 0;
  if (words) *words = look.goal.next;
  while (rig.seconds() < limit) {
    const auto drive = drives_of_words().find(look.goal.next);
    const bool as_before = look.goal.next.find(" on as before") != std::string::npos;
    if (drive == drives_of_words().end() && !as_before) throw Error("not in this study: " + look.goal.next);
    const double from = rig.seconds();
    while (rig.seconds() < from + manoeuvre_seconds - 0.5 * period) {
      if (advised && !as_before)
        rig.manoeuvre(drive->second, rig.seconds() - from);
      else
        rig.go_on();
      if (!is_look(rig.seconds())) continue;
      look = rig.look(goal);
      if (look.goal.reached) return rig.seconds() - begin;
    }
  }
  return limit - begin;
}

/// What drives of the kind reach at a time: root mean squares of their worst directions.
GoalOptions goal_of_kind(const Kind& kind, int drives, double seconds) {
  detail::Vector6d sum = detail::Vector6d::Zero();
  for (int seed = 1; seed <= drives; ++seed) {
    Rig rig(kind, static_cast<int>(seconds / period) + 1, 9000 + static_cast<std::uint64_t>(seed));
    while (rig.seconds() < seconds - 0.5 * period) rig.go_on();
    sum += rig.look({}).error.cwiseAbs2() / drives;
  }
  const detail::Vector6d rms = sum.cwiseSqrt();
  return {kind.loose * rms.tail<3>().maxCoeff(), rms.head<3>().maxCoeff(), kind.platform};
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("manoeuvre_study", "time to a goal with and without the manoeuvre that is advised");
  int drives = 20, first_seed = 1;
  double begin = 40, limit = 800;
  std::string write, only;
  bool verbose = false;
  app.add_option("--drives", drives, "of each kind").check(cli::Check::range(1, 10000)).show_default();
  app.add_option("--first-seed", first_seed, "of each kind")
      .check(cli::Check::range(1, 1'000'000))
      .show_default();
  app.add_option("--begin", begin, "time of the advice [s]").show_default();
  app.add_option("--limit", limit, "end of the drive [s]").show_default();
  app.add_option("--only", only, "kinds whose names contain this");
  app.add_option("--write", write, "a page: put the table in its place");
  app.add_flag("--verbose", verbose, "every drive");
  if (const auto code = app.parse(argc, argv)) return *code;
  bench::Table table{"manoeuvres",
                     {{"drives", "asked", "a manoeuvre is advised", "it halves the time to the goal",
                       "median: as before [s]", "as advised [s]"}}};
  int all_advice = 0, all_halved = 0;
  for (const Kind& kind : kinds) {
    if (std::string(kind.name).find(only) == std::string::npos) continue;
    const GoalOptions goal = goal_of_kind(kind, drives, 2 * begin);
    int asked = 0, advice = 0, halved = 0;
    std::vector<double> before, with;
    for (int seed = first_seed; seed < first_seed + drives; ++seed) {
      const auto number = static_cast<std::uint64_t>(seed);
      std::string words;
      const double usual = seconds_to_goal(kind, number, goal, begin, limit, false, &words);
      if (!(usual > 0)) continue;
      const double advised = seconds_to_goal(kind, number, goal, begin, begin + usual, true, nullptr);
      ++asked;
      if (drives_of_words().contains(words)) {
        ++advice;
        halved += advised <= 0.5 * usual;
      }
      before.push_back(usual);
      with.push_back(advised);
      if (verbose)
        std::printf("%s %d: %.0f s, as advised %.0f s: %s\n", kind.name, seed, usual, advised, words.c_str());
    }
    all_advice += advice;
    all_halved += halved;
    if (before.empty()) continue;
    const auto median = [](std::vector<double>& values) {
      std::sort(values.begin(), values.end());
      return std::to_string(std::llround(values[values.size() / 2]));
    };
    table.rows.push_back({kind.name, std::to_string(asked), bench::part(advice, asked),
                          bench::part(halved, advice), median(before), median(with)});
  }
  std::printf("%s\n", bench::markdown(table).c_str());
  if (!write.empty()) write_whole_file(write, bench::with_table(bench::read_page(write), table));
  return 5 * all_halved < 4 * all_advice ? 1 : 0;
}
