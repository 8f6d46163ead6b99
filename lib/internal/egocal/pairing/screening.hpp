// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/motions/instant.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/outcome.hpp"

namespace egocal {

/// All that a Screening remembers. Bounded; continuing from a copy gives the same bits.
struct ScreeningState {
  std::uint64_t chain = 0;          ///< of the newest accepted instant
  CongruenceScale congruence;       ///< what differences between the motions are typical
  std::optional<Instant> newest;    ///< handed in
  std::optional<Instant> accepted;  ///< the newest that was
  std::vector<Instant> first;       ///< all, while it is not known what is typical
  std::deque<Instant> doubtful;     ///< newer than the accepted one, not congruent with it
  Rejections rejections;            ///< frozen, screw congruence
};

/// What one instant led to.
struct Screened {
  /// The instants accepted earlier are withdrawn, the ones below replace them all.
  bool replaces = false;
  std::vector<Instant> accepted;  ///< in the order of time, with their chains
};

/// Instants in, believable ones out, in chains. Screw congruence decides: a pose that jumped, froze or was
/// tracked wrongly makes incongruent motions with its neighbours, while those are congruent with each other.
/// It alone is rejected. Three poses that agree with each other and not with those before (tracking lost and
/// found again elsewhere) begin a new chain; two might be a glitch that passes. What was accepted before it
/// was known what is typical is screened once more, for a wrong pose among the first would stay in every long
/// motion across it.
class Screening {
 public:
  explicit Screening(const ScreeningOptions& options);
  Screening(const ScreeningOptions& options, ScreeningState state);

  /// Takes the next instant, with the chain it has for its clocks. period_us: typical time between instants.
  Screened push(const Instant& instant, std::int64_t period_us);
  /// No more instants will come: those that still wait for a confirmation are rejected.
  void finish();

  const ScreeningState& state() const { return state_; }

 private:
  void screen(const Instant& instant, double period_us, std::vector<Instant>& accepted);
  void confirm(const std::vector<Instant>& confirmed, const Instant& instant, std::vector<Instant>& accepted);
  void accept(Instant instant, std::uint64_t number, std::vector<Instant>& accepted);
  void begin_chain();
  std::vector<Instant> screen_first_ones_again(double period_us);

  ScreeningOptions options_;
  ScreeningState state_;
};

}  // namespace egocal
