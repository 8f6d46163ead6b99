// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/answer_age.hpp"
#include "egocal/bus/departure.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/bus/stream_watch.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/calibration_t.hpp"
#include "egocal/command_t.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/monitor/history.hpp"
#include "egocal/problem_t.hpp"
#include "egocal/status_t.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal::monitor {

/// The time at which something reaches the model: it has no clock of its own. Ages are taken on mono, wall is
/// for people.
struct Now {
  std::int64_t mono_us = 0;
  std::int64_t wall_us = 0;
};

struct ModelOptions {
  double heartbeat_timeout = 3.0;  ///< [s] a process silent for longer counts as gone
  double stream_timeout = 2.0;     ///< [s] likewise the problems of a pair and the answers of a solver
  /// A verdict is old where motions have come for this time since, and this more for each pair [s]: the
  /// diagnosis judges one pair after another, each in less than 0.1 s of its 4 % of a core.
  double judged_within = 10, judged_within_per_pair = 3;
  bus::AnswerAgeOptions answer_age;  ///< when an answer is old
  /// Pairing lives, and has found no new motion for longer [s]: ten steps of the slowest sensors.
  double standing = 5;
  double max_gap = 0.5;  ///< [s] of measured time between two problems; more is reported as a gap
  // Study of these: tests/monitor/test_model.cpp.
  /// A certificate, a fallback or a pause must have lasted this long before its end is an event [s]: solvers
  /// alternate, people do not.
  double settle = 1;
  /// What processes lose and reject within this time after a pause or a seek comes of it [s]: pairing waits a
  /// second at most for what is missing, and a status comes once a second.
  double excused = 5;
  double repeat = 30;           ///< the same event again within this time is only counted [s]
  double many_outliers = 0.05;  ///< a larger part of the motions says that a sensor is at fault
  /// No session lasts longer: a time beyond it is not drawn [s]. A leap year.
  double longest_session = 366 * 86400.0;
  std::size_t most_reasons = 64;  ///< for which a process rejects messages: a bound on memory
  /// The monitor's own process: it is never listed as gone, though its status returns to nobody without a
  /// network. 0: none.
  std::string own_host{};
  std::int32_t own_pid = 0;
};

enum class Severity { info, good, warning, bad };

struct Event {
  Now at;
  Severity severity = Severity::info;
  std::string subject;  ///< "lidar -> camera", the name of a process, "stderr"
  std::string text;
  int repeated = 1;  ///< the same again within a short time is counted, not listed
};

using bus::Role;

/// The answers of one solver for one pair.
struct SolverTrack {
  std::string name;
  Role role = Role::fast;  ///< or Role::global
  calibration_t answer;    ///< the newest
  bool verified = false;   ///< against its problem, by this monitor
  Now at;                  ///< its arrival
  bool silent = false;
  std::int64_t answers = 0;
  /// Since when this solver answers on its own, without the global solver; empty: it does not.
  std::optional<std::int64_t> alone_mono_us{};
  bool settled = false;  ///< it once did for ModelOptions::settle: what it asks for before is no fallback
  History history;       ///< over seconds of measured time since the session began
};

enum class ReferenceKind { none, truth, nominal };

/// An answer, made plain.
struct Shown {
  bool valid = false;  ///< all values of the transform are finite and the quaternion is one
  Pose T_a_b;
  Observability
      observability;  ///< as the newest verdict of the session judges it, or as the solver states it
  ReferenceKind reference = ReferenceKind::none;
  double error_translation = 0;  ///< against the reference (32) [m]; NaN without one
  double error_rotation = 0;     ///< [rad]
};

/// The newest verdict about a pair's session.
struct PairVerdict {
  Diagnosis diagnosis;
  bus::Judged judged;
  std::string sender;
  std::int64_t seq = 0;  ///< of the problem that was judged
  Now at;                ///< arrival
  /// Since when motions come that the verdict does not know; empty: it knows all.
  std::optional<std::int64_t> behind_mono_us{};
  double old = 0;  ///< longer than that of a diagnosis that works: for so long [s]
};

/// Why the motions of a pair do not follow each other in time, where a user asked for it.
struct Interruption {
  enum class Kind { pause, seek } kind = Kind::pause;
  int jumps = 1;             ///< seeks whose jump has not been seen yet
  std::int64_t mono_us = 0;  ///< when it ended, or now while it lasts
};

struct PairState {
  std::string a, b;
  bool has_problem = false;
  problem_t problem;  ///< the newest, without its blocks
  Now problem_at;
  bool silent = false;
  std::int64_t motion_mono_us = 0;  ///< when the newest motion came
  double standing = 0;              ///< for so long none came, though pairing lives [s]; 0: they come
  std::string why_standing;         ///< the likely cause; empty: nothing is wrong, or nothing is known
  bool standing_reported = false;
  std::int64_t session = 0;
  std::optional<PairVerdict> verdict;
  std::optional<bus::CheckedScale> scale;  ///< where the rig says scale = "auto" of one of the sensors
  std::vector<SolverTrack> solvers;
  std::optional<calibration_t> previous;  ///< the answer that counted when the last session ended
  int behind_in_a_row = 0;                ///< newest problems that are older than the answer that counts
  bus::AnswerAge unanswered;
  /// How old the answer that counts is where it is not one of the present [s]: for so long no solver has
  /// answered what came since, or nothing has come from pairing.
  double old = 0;
  int counted = -1;  ///< the solver whose answer counts (egocal::outranks); -1: no answer yet
  Shown shown;
  /// Measured time [s since the session began] from which on only the fast solver ran; empty while the global
  /// one does.
  std::optional<double> only_fast_since;
  bool certified = false;  ///< as shown; a moment without a certificate does not unset it
  std::int64_t certified_mono_us = 0;
  std::int64_t fallback_mono_us = 0;
  bool fallback = false, fallback_at_start = false;
  double reported_time_offset = 0;
  bool time_offset_known = false;
  double reported_left_out = 0;  ///< share of the motions that contradict the others, as last reported
  std::int64_t gap_count = 0;
  /// Whether the pair is paused by the commands received; motions that are still accepted override it.
  bool paused = false;
  std::int64_t paused_mono_us = 0;
  std::int64_t idle_mono_us = 0;  ///< when last there was nothing to solve
  std::optional<Interruption> interruption;
  std::optional<std::int64_t> reset_asked;  ///< the session that a command asked to forget
  /// Whether the monitor has no network, or nothing of pairing has come since: the silence is not pairing's.
  bool no_network = false;
  bool ended = false;         ///< every pairing process that was heard has reported its end
  bool pairing_runs = false;  ///< one of them is alive

  const calibration_t* answer() const {
    return counted < 0 ? nullptr : &solvers[static_cast<std::size_t>(counted)].answer;
  }
  const SolverTrack* counted_solver() const {
    return counted < 0 ? nullptr : &solvers[static_cast<std::size_t>(counted)];
  }
};

struct ProcessState {
  status_t status;                  ///< the newest
  std::optional<bus::State> state;  ///< its state; empty: unknown to this version
  Now at;
  bool alive = true;
  bool known = true;                  ///< false: the monitor has no network, alive is of before
  std::chrono::seconds announced{0};  ///< silence, by its newest status, because it computes
  bool computes = false;              ///< it is silent for longer than others may be, as it has announced
  double rate_in = 0, rate_out = 0;   ///< [1/s]; negative: unknown
  std::int64_t in = 0, out = 0;
  std::int64_t lost = 0, rejected = 0;   ///< without what comes of a pause or a seek
  std::vector<bus::Refusal> rejections;  ///< by reason, with its cure where one is known
  std::int64_t rate_mono_us = 0, rate_in_count = 0, rate_out_count = 0;
  struct Tally {
    std::int64_t newest = 0, excused = 0;
  };
  std::map<std::string, Tally> tallies{};         ///< of the counters that a pause or a seek raises
  std::int64_t seeks = 0;                         ///< of a player
  std::string reported_error{};                   ///< the last event
  std::optional<std::int64_t> resumed_mono_us{};  ///< when its last pause ended
  /// The process before this one: heard again, both are running.
  std::optional<std::pair<std::int64_t, std::int32_t>> run_before{};
};

/// Everything the monitor knows: messages in, plain data out. Names are kept as sent, drawing makes them
/// safe. Bounded in memory whatever arrives: what is beyond the limits below is counted in ignored().
class Model {
 public:
  explicit Model(const ModelOptions& options = {}) : options_(options) {}

  /// Shows a pair before its first message, e.g. because the rig names it.
  void expect_pair(const std::string& a, const std::string& b);

  void on_problem(const problem_t& message, Now now);
  /// A checked answer with the certificate that this listener computed (bus/answer_check.hpp). Not verified:
  /// its problem has not been received, and it never replaces a verified one.
  void on_calibration(const calibration_t& message, Now now, bool verified = true);
  /// A checked verdict: of this pair's session, or it is ignored.
  void on_verdict(const verdict_t& message, const bus::ReceivedVerdict& received, Now now);
  /// A checked scale of this pair.
  void on_scale(const scale_t& message, const bus::CheckedScale& scale, Now now);
  void on_status(const status_t& message, Now now);
  void on_command(const command_t& message, Now now);
  /// What is to be said of the sensors' streams now.
  void set_streams(std::vector<bus::StreamLine> lines) { streams_ = std::move(lines); }
  /// Why a pair has no new motion, see bus::why_no_motion().
  void set_why_standing(std::size_t pair, const std::string& why) { pairs_.at(pair).why_standing = why; }

  /// Why this monitor has no network; empty: it has.
  void set_network(const std::string& error, Now now);

  /// A line for the list of events from outside, e.g. captured standard error.
  void note(Severity severity, const std::string& subject, const std::string& text, Now now);
  /// Lets time pass: finds out who has gone silent. To be called a few times a second.
  void tick(Now now);

  const std::vector<PairState>& pairs() const { return pairs_; }
  const std::vector<ProcessState>& processes() const { return processes_; }
  /// A line for each sensor and for each kind of fault in what it sends; empty: they are not watched.
  const std::vector<bus::StreamLine>& streams() const { return streams_; }
  const std::deque<Event>& events() const { return events_; }  ///< oldest first
  std::int64_t events_seen() const { return events_seen_; }    ///< ever, also those that are no longer kept
  std::int64_t ignored() const { return ignored_; }
  std::int64_t messages() const { return messages_; }
  /// Whether anything of another process than this one was heard.
  bool heard_others() const;
  Now now() const { return now_; }
  const ModelOptions& options() const { return options_; }

  /// As many pairs as a rig file may have: all of 23 sensors.
  static constexpr std::size_t max_pairs = 256, max_processes = 64, max_solvers = 4, max_events = 1000;
  static constexpr std::size_t max_text = 200;  ///< bytes kept of any text

 private:
  PairState* find_pair(const std::string& a, const std::string& b);
  void follow_back(PairState& pair, const problem_t& message, Now now);
  void begin_session(PairState& pair, std::int64_t session);
  void note_outliers(PairState& pair, Now now);
  void note_time_offset(PairState& pair, Now now);
  Role role_of(const calibration_t& message) const;
  SolverTrack& track_of(PairState& pair, const calibration_t& message, Now now);
  void count_answer(PairState& pair, Now now);
  void watch_rejections(ProcessState& process, const std::string& reason, std::int64_t count, Now now);
  void watch_certificate(PairState& pair, Now now);
  void watch_verdict(const PairState& pair, const PairVerdict& verdict, Now now);
  void watch_age_of_verdict(PairState& pair, Now now);
  void note_unanswered(PairState& pair, Now now);
  void watch_age_of_answer(PairState& pair, Now now);
  void watch_motions(PairState& pair, Now now);
  void watch_loops(Now now);
  void watch_processes(Now now);
  void watch_solvers(PairState& pair, Now now);
  void watch_fallback(PairState& pair, SolverTrack& track, const calibration_t& message, Now now);
  void watch_time(PairState& pair, const problem_t& message, Now now);
  void note_new_session(PairState& pair, std::int64_t session, Now now);
  ProcessState* process_of(const status_t& message);
  ProcessState* new_process(const status_t& message, Now now);
  void follow(ProcessState& process, const status_t& message, Now now);
  void watch_error(ProcessState& process, const std::string& error, Now now);
  void watch_seeks(ProcessState& process, const status_t& message, bool is_first, Now now);
  void interrupt(PairState& pair, Interruption::Kind kind, int jumps, Now now);
  void watch_interruptions(Now now);
  void count_messages(ProcessState& process, const status_t& message, bool is_new, Now now);
  bool is_own(const ProcessState& process) const;
  bool pairing_has_ended() const;

  ModelOptions options_;
  std::vector<PairState> pairs_;
  std::vector<ProcessState> processes_;
  std::vector<bus::StreamLine> streams_;
  std::deque<Event> events_;
  std::set<std::array<std::string, 3>> open_loops_;
  std::int64_t ignored_ = 0;
  std::int64_t events_seen_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t excused_mono_us_ = 0;  ///< until then processes lose and reject because of a pause or a seek
  bool network_away_ = false;
  std::int64_t network_mono_us_ = 0;  ///< when the network went away or came back
  Now now_;
};

/// Whether a pair's calibration was paused by a user: by the commands received for it, or because
/// pairing reports it of all its pairs (a monitor that started later has received no command).
bool pair_is_paused(const Model& model, const PairState& pair);
/// Whether there are answers, and the pairing process whose problems they answer sends nothing, though it has
/// not reported its end: it hangs or is gone. A pairing process repeats its problems once a second.
bool pairing_is_silent(const PairState& pair);
/// Whether pairing is silent about this pair alone, for a known cause: a session has begun in which it finds
/// no motion, and so sends no problem.
bool session_has_no_motion(const PairState& pair);
/// How far the answer that counts is from the one that was called good; empty: the verdict holds for it.
std::optional<bus::Departure> departure_of(const PairState& pair);
/// Whether the answer is verified and proven, its verdict is good and about it, and both are of the present.
bool is_good(const PairState& pair);
/// "lidar -> camera", for events and lines.
std::string pair_name(const std::string& a, const std::string& b);
/// An answer made plain, with its error against the pair's truth, else against its nominal value.
Shown shown_of(const PairState& pair, const calibration_t& answer);
/// A pose from the wire; empty unless all values are finite and the quaternion is of a sensible length (it is
/// normalised).
std::optional<Pose> pose_from(const double pos[3], const double quat_wxyz[4]);

}  // namespace egocal::monitor
