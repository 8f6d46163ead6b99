// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "player/printed_text.hpp"

namespace egocal::services {

Console::Console() : terminal_(isatty(STDERR_FILENO) != 0) {}

void Console::say(const std::string& line) {
  std::fprintf(stderr, "%segocal-player: %s\n", line_open_ ? "\n" : "", line.c_str());
  line_open_ = false;
}

void Console::say_damage(const bus::LogDamage& damage, std::uint64_t most_reported) {
  if (damage.regions <= reported_regions_ && damage.jumps <= reported_jumps_) return;
  if (damage_lines_ < most_reported)
    say(printed_text("the log is damaged here: %llu bytes and at least %llu events lost so far",
                     static_cast<unsigned long long>(damage.bytes),
                     static_cast<unsigned long long>(damage.lost_events)));
  else if (damage_lines_ == most_reported)
    say("the log is damaged in more places; their number will be reported at the end");
  damage_lines_ = std::min(damage_lines_, most_reported) + 1;
  take_as_reported(damage);
}

void Console::take_as_reported(const bus::LogDamage& damage) {
  reported_regions_ = damage.regions;
  reported_jumps_ = damage.jumps;
}

void Console::report(const std::string& log, const Tape& tape) {
  const bus::LogDamage& damage = tape.damage();
  if (damage.any())
    say(printed_text("%s: %llu damaged region%s skipped, %llu bytes and at least %llu event%s lost%s",
                     log.c_str(), static_cast<unsigned long long>(damage.regions),
                     damage.regions == 1 ? "" : "s", static_cast<unsigned long long>(damage.bytes),
                     static_cast<unsigned long long>(damage.lost_events), damage.lost_events == 1 ? "" : "s",
                     damage.truncated ? "; the log is cut off" : ""));
  if (tape.damaged_times() > 0)
    say(printed_text("%llu events with damaged times were played when their neighbours were",
                     static_cast<unsigned long long>(tape.damaged_times())));
  if (tape.skipped() > 0)
    say(printed_text("%llu events of egocal's own channels (EGOCAL_*) were skipped; --channel plays them",
                     static_cast<unsigned long long>(tape.skipped())));
}

void Console::show(const Progress& progress, std::int64_t mono_us, std::int64_t period_us, bool last) {
  if (!terminal_ || (last && progress.messages == 0)) return;
  if (!last && mono_us - shown_mono_us_ < period_us) return;
  shown_mono_us_ = mono_us;
  const std::string state = progress.paused       ? "paused"
                            : progress.speed == 0 ? "playing, full speed"
                                                  : printed_text("playing x %g", progress.speed);
  std::fprintf(stderr, "\r%-20s %3.0f %%  %8.1f s  %llu messages  %s\x1b[K", state.c_str(),
               100 * progress.part, progress.seconds, static_cast<unsigned long long>(progress.messages),
               progress.typed.c_str());
  if (last) std::fputc('\n', stderr);
  line_open_ = !last;
  std::fflush(stderr);
}

}  // namespace egocal::services
