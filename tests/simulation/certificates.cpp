// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/certificates.hpp"

#include <algorithm>
#include <cstdio>

#include "bench/extended_reference.hpp"
#include "egocal/bus/answer_check.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "simulation/checks_common.hpp"

namespace egocal::simulation {

namespace {

using bench::Extended;

std::string line(const char* what, Extended is, Extended limit) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.6g, at most %.6g", what, static_cast<double>(is),
                static_cast<double>(limit));
  return text;
}

/// Of one answer to one problem (spatial mode).
std::string objection_to(const Problem& problem, const Answer& answer) {
  const Matrix8d Q = cost_matrix(problem);
  const Certificate own = verify(Q, answer.T_a_b);
  bench::Reference best = bench::reference(Q, {answer.T_a_b});
  if (!best.proven) best = bench::reference(Q, {answer.T_a_b, solve_dual(Q).q, solve_sdp(Q).q});
  const Extended cost = bench::extended_cost(Q, answer.T_a_b);
  const Extended least = std::max(best.cost, Extended(0));
  const Extended rounding = own.rounding;
  const Extended claimed = answer.certificate.cost;
  const Extended off = claimed < cost ? cost - claimed : claimed - cost;
  if (off > 4 * rounding) return line("its cost is off", off, 4 * rounding);

  // as the certificate states it: no better one within its domain, except for those within reach
  const ExtrinsicError distance = extrinsic_error(best.q, answer.T_a_b);
  if (distance.translation > own.domain) return "";
  const Extended bound = answer.certificate.lower_bound;
  if (bound > least + rounding + Extended(cost_rounding(Q, best.q)))
    return line("its lower bound is above the minimum", bound, least);
  const CertificateOptions options;
  const bool near =
      distance.translation <= options.reach_translation && distance.rotation <= options.reach_rotation;
  if (cost - least > rounding && !near)
    return line("it is certified, and its cost is above the minimum", cost - least, rounding);
  return "";
}

}  // namespace

void Certificates::take_problem(const std::string& channel, bus::Bytes message) {
  numbers_[channel].insert({field(message, session_at), field(message, seq_at)});
  std::deque<std::vector<std::byte>>& kept = problems_[channel];
  std::vector<std::byte> bytes;
  if (kept.size() >= most_kept) {
    bytes = std::move(kept.front());  // its memory serves again
    kept.pop_front();
  }
  bytes.assign(message.begin(), message.end());
  kept.push_back(std::move(bytes));
}

bool Certificates::knows(const std::string& channel, std::int64_t session, std::int64_t seq) const {
  const auto numbers = numbers_.find(channel);
  return numbers != numbers_.end() && numbers->second.contains({session, seq});
}

std::string Certificates::objection(const std::string& channel, const calibration_t& message) {
  if (message.status != bus::wire_status(Optimality::certified)) return "";
  const bus::Checked<Answer> answer = bus::to_answer(message);
  if (!answer) return "";
  std::string objection;
  for (const std::vector<std::byte>& bytes : problems_[channel]) {
    if (field(bytes, session_at) != message.session || field(bytes, seq_at) != message.seq) continue;
    problem_t sent{};
    if (!bus::decode(bytes, sent) || sent.utime != message.utime) continue;
    const bus::Checked<Problem> problem = bus::to_problem(sent);
    if (!problem || problem.value->mode != Mode::spatial) continue;
    ++checked_;
    objection = objection_to(*problem.value, *answer.value);
    // two pairing processes may give the same number to two problems
    if (objection.empty()) return "";
  }
  return objection;
}

}  // namespace egocal::simulation
