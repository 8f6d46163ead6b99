// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/answer_check.hpp"

#include <algorithm>

#include "egocal/certificate/certificate.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::bus {

namespace {

/// Largest difference of two extrinsics that are equal up to the rounding of conversions [1, m].
constexpr double same_pose = 1e-9;

const std::string denied = "answer that claims a certificate which its problem denies";
const std::string denied_verdict = "verdict that calls an answer good which its problem denies";

bool same(const DualQuaternion& x, const DualQuaternion& y) {
  const Vector8d difference = canonical_sign(x).vec() - canonical_sign(y).vec();
  const double length = 1 + x.vec().tail<4>().norm();
  return difference.norm() <= same_pose * length;
}

/// Q: certified_cost() of the problem.
Certificate verified(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b) {
  if (problem.mode == Mode::spatial) return verify(Q, T_a_b);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = planar_from_extrinsic(T_a_b, G_a, G_b);
  Certificate certificate = verify_planar(Q, T_p);
  // the projection onto the plane is optimal, the answer itself lies off it
  if (!same(extrinsic_from_planar(T_p, G_a, G_b), T_a_b)) certificate.optimality = Optimality::undecided;
  return certificate;
}

}  // namespace

std::string AnswerCheck::take(const problem_t& message) {
  Checked<Problem> problem = to_problem(message);
  if (!problem) return problem.reason;
  Pair& pair = pairs_.touch(message.sensor_a, message.sensor_b);
  Known known{message.session, message.seq, message.utime, certified_cost(*problem.value),
              std::move(*problem.value)};
  known.problem.blocks.clear();
  const auto again = std::find_if(pair.problems.begin(), pair.problems.end(), [&](const Known& k) {
    return k.session == known.session && k.seq == known.seq && k.utime == known.utime;
  });
  if (again != pair.problems.end()) {
    *again = std::move(known);
  } else if (pair.problems.size() < problems_per_pair) {
    pair.problems.push_back(std::move(known));
  } else {
    pair.problems[pair.next] = std::move(known);
    pair.next = (pair.next + 1) % problems_per_pair;
  }
  return {};
}

template <class Message>
const AnswerCheck::Known* AnswerCheck::find(const Message& message) const {
  const Pair* const pair = pairs_.find(message.sensor_a, message.sensor_b);
  if (!pair) return nullptr;
  const auto known = std::find_if(pair->problems.begin(), pair->problems.end(), [&](const Known& k) {
    return k.session == message.session && k.seq == message.seq && k.utime == message.utime;
  });
  return known == pair->problems.end() ? nullptr : &*known;
}

CheckedAnswer AnswerCheck::check(const calibration_t& message) const {
  CheckedAnswer checked;
  Checked<Answer> answer = to_answer(message);
  if (!answer) {
    checked.reason = answer.reason;
    return checked;
  }
  checked.answer = std::move(*answer.value);
  const Optimality claimed = checked.answer.certificate.optimality;
  const Known* known = find(message);
  if (!known) {
    checked.standing = Standing::unverified;
    if (claimed == Optimality::certified) checked.answer.certificate.optimality = Optimality::undecided;
    return checked;
  }
  checked.answer.certificate = verified(known->problem, known->Q, checked.answer.T_a_b);
  if (claimed == Optimality::certified && checked.answer.certificate.optimality != Optimality::certified) {
    checked.reason = denied;
    return checked;
  }
  checked.standing = Standing::verified;
  checked.problem = known->problem;
  return checked;
}

std::string AnswerCheck::refusal(const verdict_t& message, const ReceivedVerdict& received) const {
  if (received.diagnosis.verdict != Verdict::good) return {};
  const Known* known = find(message);
  if (!known) return {};
  const Certificate certificate = verified(known->problem, known->Q, received.judged.T_a_b);
  return certificate.optimality == Optimality::certified ? "" : denied_verdict;
}

void set_certificate(const CheckedAnswer& checked, calibration_t& message) {
  set_certificate(checked.answer.certificate, message);
}

bool outranks(const StandingRank& x, const StandingRank& y) {
  if (x.standing != y.standing) return x.standing < y.standing;
  return egocal::outranks(x.rank, y.rank);
}

StandingRank rank_of(const CheckedAnswer& checked, const calibration_t& message) {
  const Certificate& certificate = checked.answer.certificate;
  return {checked.standing, {message.session, message.seq, certificate.optimality, certificate.cost}};
}

}  // namespace egocal::bus
