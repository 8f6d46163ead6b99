// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Random problems, honest answers, local minima and falsified ones against a reference in extended precision:
// is anything certified that is not the optimum, and how many optima go without a certificate? A problem is
// made from its number alone, so any line of the output can be made again with --first NUMBER --problems 1.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Eigenvalues>

#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/sqp.hpp"
#include "extended_reference.hpp"
#include "support/random_motion.hpp"

namespace {

using namespace egocal;
using bench::Extended;
using testing::Motion;
using testing::Random;

struct Case {
  bool planar = false;
  bool degenerate = false;  ///< near-degenerate by construction: no certificate is owed
  Matrix8d Q;
};

/// Sensors with parallel axes on a vehicle that turns about z and hardly tilts: entries of Q cancel.
std::vector<MotionPair> aligned_vehicle(Random& random) {
  const double tilt = random.log_uniform(1e-11, 1e-5);
  const double yaw = random.normal();
  const DualQuaternion T = testing::displacement({0, 0, yaw}, random.normal3());
  std::vector<MotionPair> pairs(2 + random.below(300));
  for (MotionPair& pair : pairs) {
    Eigen::Vector3d turn = random.normal3(tilt), shift = random.normal3(tilt);
    turn.z() = 0.1 * random.normal();
    shift.x() = 1 + 0.1 * random.normal();
    pair.a = testing::displacement(turn, shift);
    const Eigen::Vector3d turn_error = random.normal3(1e-3 * tilt), shift_error = random.normal3(tilt);
    pair.b = normalized(conjugate(T) * pair.a * T * testing::displacement(turn_error, shift_error));
  }
  return pairs;
}

/// Rotations without noise and translations with it: D is singular, the cost is not small.
std::vector<MotionPair> exact_rotations(Random& random) {
  const DualQuaternion T = testing::random_extrinsic(random, random.log_uniform(0.1, 100));
  const double noise = random.log_uniform(1e-9, 0.3);
  std::vector<MotionPair> pairs(3 + random.below(300));
  for (MotionPair& pair : pairs) {
    const Eigen::Vector3d turn = random.normal3(0.1), shift = random.normal3(), error = random.normal3(noise);
    pair.b = testing::displacement(turn, shift);
    pair.a = T * pair.b * conjugate(T) * testing::displacement({0, 0, 0}, error);
  }
  return pairs;
}

/// Noise 1e-6 to 0.5, 1 to 1000 pairs, a third of them near-degenerate, a quarter of the others planar.
Case make_case(std::uint64_t number) {
  Random random(number);
  Case made;
  testing::RandomDrive drive;
  drive.noise = random.log_uniform(1e-6, 0.5);
  drive.pairs = static_cast<std::uint64_t>(random.log_uniform(1, 1001));
  drive.rotation = random.log_uniform(0.01, 0.5);
  drive.translation = random.log_uniform(0.05, 5);
  drive.flip_signs = true;
  const std::uint64_t kind = random.below(12);
  made.degenerate = kind < 4 || drive.pairs < 3;
  const std::uint64_t special = kind < 4 ? random.below(9) : 0;
  if (special >= 6) {
    const Balance balance{1, random.log_uniform(1e-3, 1)};
    if (special == 8) drive.noise = 0.01;
    made.Q = testing::cost_of(special == 6 ? aligned_vehicle(random)
                              : special == 7
                                  ? exact_rotations(random)
                                  : testing::random_pairs(testing::random_extrinsic(random), drive, random),
                              balance);
    if (special == 8) made.Q *= random.log_uniform(1e-300, 1e-290) * 1e-20;  // below what doubles can hold
    return made;
  }
  made.planar = kind >= 10 || (kind < 4 && random.below(4) == 0);
  drive.motion = made.planar ? Motion::planar : kind % 2 ? Motion::free : Motion::dominant_axis;
  if (kind < 4) {
    switch (special) {
      case 0:
        drive.noise = 0;
        break;
      case 1:
        drive.noise = random.log_uniform(1e-12, 1e-7);
        break;
      case 2:
        drive.pairs = 1 + random.below(2);
        break;
      case 3:
        drive.motion = made.planar ? Motion::planar : Motion::single_axis;
        break;
      case 4:
        drive.motion = Motion::translation;
        break;
      default:
        drive.rotation = random.log_uniform(1e-9, 1e-3);
        break;
    }
  }
  const double size = random.log_uniform(0.1, 100);
  const DualQuaternion T =
      made.planar ? testing::random_planar_extrinsic(random, size) : testing::random_extrinsic(random, size);
  const Balance balance{1, random.log_uniform(1e-3, 1)};
  made.Q = testing::cost_of(testing::random_pairs(T, drive, random), balance);
  return made;
}

/// Directions x (half rotation vector, half translation, in sensor b's frame) that the cost feels least.
Eigen::Matrix<double, 6, 6> flat_directions(const Matrix8d& Q, const DualQuaternion& q) {
  Eigen::Matrix<double, 8, 6> basis;
  const Matrix8d left = left_matrix(q);
  basis << left.middleCols<3>(1), left.rightCols<3>();
  const Matrix8d Z = lagrangian_matrix(Q, least_squares_multipliers(Q, q));
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(basis.transpose() * Z * basis)
      .eigenvectors();
}

/// The optimum falsified by 0.001 to 20 deg and 0.1 mm to 20 m, one of both or both, along a flat direction
/// half of the time.
DualQuaternion falsified(const Case& problem, const DualQuaternion& optimum, Random& random) {
  const double rotation = random.log_uniform(0.001, 20) * std::numbers::pi / 180;
  const double translation = random.log_uniform(1e-4, 20);
  const std::uint64_t which = random.below(3);
  Eigen::Vector3d turn = random.direction(), shift = random.direction();
  if (random.below(2) == 0) {
    const Eigen::Matrix<double, 6, 1> x =
        flat_directions(problem.Q, optimum).col(static_cast<int>(random.below(3)));
    // the whole direction, as long as the larger of its two parts says
    const double scale = which == 0 ? rotation / std::max(1e-12, 2 * x.head<3>().norm())
                                    : translation / std::max(1e-12, 2 * x.tail<3>().norm());
    turn = 2 * scale * x.head<3>();
    shift = 2 * scale * x.tail<3>();
    if (turn.norm() > 0.5) {
      shift *= 0.5 / turn.norm();
      turn *= 0.5 / turn.norm();
    }
  } else {
    turn *= which == 1 ? 0 : rotation;
    shift *= which == 0 ? 0 : translation;
  }
  if (problem.planar) {
    turn.head<2>().setZero();
    shift[2] = 0;
  }
  return optimum * testing::displacement(turn, shift);
}

struct Tally {
  std::uint64_t problems = 0, degenerate = 0, proven = 0;
  std::uint64_t owed = 0, certified = 0;  ///< of the global solver on problems that are not degenerate
  std::uint64_t certified_degenerate = 0;
  std::uint64_t local_starts = 0, local_minima = 0;  ///< of Newton's method from random starts
  std::uint64_t falsified = 0,
                falsified_indistinct = 0;  ///< indistinct: the cost rises by no more than rounding
  std::uint64_t false_certificates = 0;
  std::uint64_t missed = 0;  ///< global answers above the reference by more than rounding
  std::uint64_t by_reach =
      0;  ///< certified above rounding because every better one is nearer than the options say
  std::uint64_t beyond_domain =
      0;  ///< certified above rounding, the better one is outside of the stated domain
  std::uint64_t not_finite = 0;
  std::uint64_t bounds_broken = 0;   ///< a cost below a bound by more than its own rounding
  std::uint64_t reaches_broken = 0;  ///< a better extrinsic outside of the reach, within the domain
  std::uint64_t negative_costs = 0;  ///< certified below minus rounding
  std::uint64_t invalid = 0, invalid_certified = 0;  ///< what is no extrinsic or no cost matrix

  void operator+=(const Tally& t) {
    problems += t.problems;
    degenerate += t.degenerate;
    proven += t.proven;
    owed += t.owed;
    certified += t.certified;
    certified_degenerate += t.certified_degenerate;
    local_starts += t.local_starts;
    local_minima += t.local_minima;
    falsified += t.falsified;
    falsified_indistinct += t.falsified_indistinct;
    false_certificates += t.false_certificates;
    missed += t.missed;
    by_reach += t.by_reach;
    beyond_domain += t.beyond_domain;
    not_finite += t.not_finite;
    bounds_broken += t.bounds_broken;
    reaches_broken += t.reaches_broken;
    negative_costs += t.negative_costs;
    invalid += t.invalid;
    invalid_certified += t.invalid_certified;
  }
};

std::mutex printing;

void report(const char* what, std::uint64_t number, const Certificate& certificate, Extended excess) {
  const std::lock_guard<std::mutex> lock(printing);
  std::printf("%s: problem %llu cost %.17g excess %.3g rounding %.3g gap %.3g reach %.3g m %.3g rad\n", what,
              static_cast<unsigned long long>(number), certificate.cost, static_cast<double>(excess),
              certificate.rounding, certificate.gap, certificate.reach_translation,
              certificate.reach_rotation);
}

/// What may be certified: a cost within rounding of the optimum, or an answer that is the optimum to 1 um and
/// 1 urad. A better one further away than the certificate states (its domain, 10,000 lengths at least) is
/// counted by itself: there the rounding of Q decides.
bool is_false(const Case&, const Certificate& c, const DualQuaternion& q, const bench::Reference& best,
              Extended excess, Tally& tally) {
  if (c.optimality != Optimality::certified || excess <= Extended(c.rounding)) return false;
  const ExtrinsicError distance = extrinsic_error(best.q, q);
  const CertificateOptions options;
  if (distance.translation <= options.reach_translation && distance.rotation <= options.reach_rotation) {
    ++tally.by_reach;
    return false;
  }
  if (distance.translation > c.domain) {
    ++tally.beyond_domain;
    return false;
  }
  return true;
}

/// What is stated of every other extrinsic, held against the best one known.
void check_statements(std::uint64_t number, const Matrix8d& Q, const Certificate& c, const DualQuaternion& q,
                      const DualQuaternion& best, Tally& tally) {
  const Extended better = bench::extended_cost(Q, best);
  const ExtrinsicError distance = extrinsic_error(best, q);
  const bool within = distance.translation <= c.domain;
  if (within && better + Extended(cost_rounding(Q, best)) < Extended(c.lower_bound)) {
    ++tally.bounds_broken;
    report("BOUND BROKEN", number, c, better - Extended(c.lower_bound));
  }
  const bool outside = distance.translation > c.reach_translation * (1 + 1e-9) + 1e-300 ||
                       distance.rotation > c.reach_rotation * (1 + 1e-9) + 1e-14;
  if (within && outside && better < Extended(c.cost)) {
    ++tally.reaches_broken;
    report("REACH BROKEN", number, c, better - Extended(c.cost));
  }
  if (c.optimality == Optimality::certified && c.cost < -c.rounding) {
    ++tally.negative_costs;
    report("NEGATIVE COST CERTIFIED", number, c, 0);
  }
}

/// What may never be certified.
void check_invalid(std::uint64_t number, const Matrix8d& Q, const DualQuaternion& best, Random& random,
                   Tally& tally) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_none = [&](const Matrix8d& given, const DualQuaternion& q) {
    ++tally.invalid;
    const Certificate c = verify(given, q);
    if (c.optimality != Optimality::certified) return;
    ++tally.invalid_certified;
    report("INVALID INPUT CERTIFIED", number, c, 0);
  };
  expect_none(Q, {nan * best.real, best.dual});
  expect_none(Q, {0 * best.real, best.dual});
  expect_none(Q, {best.real, nan * best.dual});
  expect_none(Q, {random.log_uniform(2, 1e200) * best.real, best.dual});
  const int i = static_cast<int>(random.below(8)), j = (i + 1 + static_cast<int>(random.below(7))) % 8;
  Matrix8d bad = Q;
  bad(i, j) = nan;
  expect_none(bad, best);
  bad = Q;
  bad(i, j) += 0.1 * Q.trace();
  expect_none(bad, best);
  bad = Q;
  bad(i, i) -= 2 * Q.trace();  // indefinite: below any cost there is another one
  const Certificate c = verify(bad, best);
  ++tally.invalid;
  if (c.optimality == Optimality::certified && c.cost < -c.rounding) {
    ++tally.invalid_certified;
    report("INDEFINITE MATRIX CERTIFIED", number, c, 0);
  }
}

Tally study(std::uint64_t number) {
  Tally tally;
  const Case problem = make_case(number);
  const Matrix8d& Q = problem.Q;
  Random random(number ^ 0x5eed5eed5eed5eedULL);
  const auto check = [&](const DualQuaternion& q) {
    return problem.planar ? verify_planar(Q, q) : verify(Q, q);
  };

  const Solution global = problem.planar ? solve_planar(Q) : solve_dual(Q);
  bench::Reference best;
  if (problem.planar) {
    best = bench::planar_reference(Q);
  } else {
    best = bench::reference(Q, {global.q, solve_sdp(Q).q});
    if (!best.proven) {
      std::vector<DualQuaternion> starts{best.q};
      for (int i = 0; i < 4; ++i) starts.push_back(solve_sqp(Q, testing::random_extrinsic(random)).q);
      best = bench::reference(Q, starts);
    }
  }
  // Rounding may leave Q with an eigenvalue of -1e-17, and the literal minimum of such a Q lies below zero,
  // far away. The cost that Q stands for is a sum of squares.
  best.cost = std::max(best.cost, Extended(0));
  tally.problems = 1;
  tally.degenerate = problem.degenerate;
  tally.proven = best.proven;
  tally.not_finite = !global.q.vec().allFinite();

  const auto judge = [&](const char* what, const DualQuaternion& q) {
    const Certificate certificate = check(q);
    const Extended excess = bench::extended_cost(Q, q) - best.cost;
    check_statements(number, Q, certificate, q, best.q, tally);
    if (is_false(problem, certificate, q, best, excess, tally)) {
      ++tally.false_certificates;
      report(what, number, certificate, excess);
    }
    return std::pair(certificate, excess);
  };

  const auto [certificate, excess] = judge("FALSE CERTIFICATE of the global answer", global.q);
  const bool certified = certificate.optimality == Optimality::certified;
  if (excess > Extended(4 * certificate.rounding)) {
    ++tally.missed;
    if (!problem.degenerate) report("missed optimum", number, certificate, excess);
  }
  if (problem.degenerate) {
    tally.certified_degenerate = certified;
  } else {
    tally.owed = 1;
    tally.certified = certified;
    if (!certified) report("no certificate", number, certificate, excess);
  }

  if (!problem.planar && number % 8 == 0 && Q.trace() > 1e-200)
    check_invalid(number, Q, best.q, random, tally);
  if (!problem.planar) {
    const DualQuaternion q = solve_sqp(Q, testing::random_extrinsic(random)).q;
    const auto [c, above] = judge("FALSE CERTIFICATE of a local minimum", q);
    ++tally.local_starts;
    tally.local_minima += above > Extended(c.rounding);
  }
  for (int i = 0; i < 2; ++i) {
    const DualQuaternion q = falsified(problem, best.q, random);
    const auto [c, above] = judge("FALSE CERTIFICATE of a falsified answer", q);
    ++tally.falsified;
    tally.falsified_indistinct += above <= Extended(c.rounding);
  }
  return tally;
}

int usage(std::FILE* out) {
  std::fprintf(
      out,
      "usage: certificate_study [--problems N] [--first NUMBER] [--threads N]\n"
      "Checks certificates on random problems against a reference in extended precision.\n"
      "Exit 0 when nothing false was certified and at least 99.99 %% of what is owed was, 1 otherwise.\n");
  return out == stdout ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t problems = 1'000'000, first = 0;
  unsigned threads = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help") return usage(stdout);
    if (i + 1 >= argc) return usage(stderr);
    char* end = nullptr;
    const std::uint64_t value = std::strtoull(argv[++i], &end, 10);
    if (*end != '\0') return usage(stderr);
    if (option == "--problems") {
      problems = value;
    } else if (option == "--first") {
      first = value;
    } else if (option == "--threads") {
      threads = std::max(1u, static_cast<unsigned>(value));
    } else {
      return usage(stderr);
    }
  }

  std::atomic<std::uint64_t> next{first};
  std::vector<Tally> tallies(threads);
  std::vector<std::thread> workers;
  for (unsigned t = 0; t < threads; ++t)
    workers.emplace_back([&, t] {
      for (std::uint64_t number = next++; number < first + problems; number = next++)
        tallies[t] += study(number);
    });
  for (std::thread& worker : workers) worker.join();
  Tally all;
  for (const Tally& tally : tallies) all += tally;

  const auto row = [](const char* what, std::uint64_t count) {
    std::printf("| %s | %llu |\n", what, static_cast<unsigned long long>(count));
  };
  std::printf("| | |\n|---|---|\n");
  row("problems", all.problems);
  row("of them near-degenerate", all.degenerate);
  row("reference proven optimal in extended precision", all.proven);
  row("false certificates", all.false_certificates);
  row("global answers on problems that are not degenerate", all.owed);
  row("certified of these", all.certified);
  row("certified of the near-degenerate ones", all.certified_degenerate);
  row("global answers above the reference by more than rounding", all.missed);
  row("answers from random starts", all.local_starts);
  row("of these above the optimum, none certified", all.local_minima);
  row("falsified optima", all.falsified);
  row("of these with a cost that rose by no more than rounding", all.falsified_indistinct);
  row("certified above rounding, but within 1 um and 1 urad of the optimum", all.by_reach);
  row("certified, and a better one lies outside of the stated domain", all.beyond_domain);
  row("answers that are not finite", all.not_finite);
  row("bounds broken by more than rounding", all.bounds_broken);
  row("reaches broken", all.reaches_broken);
  row("certified with a cost below minus its rounding", all.negative_costs);
  row("invalid inputs", all.invalid);
  row("certified of these", all.invalid_certified);
  const bool held = all.bounds_broken + all.reaches_broken + all.negative_costs + all.invalid_certified == 0;
  const bool enough = static_cast<double>(all.certified) >= 0.9999 * static_cast<double>(all.owed);
  return all.false_certificates == 0 && all.not_finite == 0 && held && enough ? 0 : 1;
}
