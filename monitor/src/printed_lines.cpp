// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "printed_lines.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/lines.hpp"
#include "first_view.hpp"

namespace egocal::monitor {

namespace {

volatile std::sig_atomic_t stop_flag = 0;
extern "C" void on_stop(int) {
  stop_flag = 1;
}

void handle_stop() {
  struct sigaction action {};
  action.sa_handler = on_stop;
  sigemptyset(&action.sa_mask);
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal_number, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);  // a reader that has seen enough ends us through print()
}

/// Throws Error if nothing was received. Messages of this process return to it and do not count.
void require_messages(const Model& model, const Source& source) {
  if (model.heard_others()) return;
  if (!source.network_error().empty()) throw Error(source.network_error());
  throw Error(source.nothing_in_words());
}

}  // namespace

bool print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  if (errno == EPIPE) return false;
  throw Error(std::string("standard output: cannot be written: ") + std::strerror(errno));
}

int run_once(const ProgramOptions& options, Model& model, Source& source, Charset charset) {
  handle_stop();
  const std::int64_t begin = bus::mono_us();
  Now now;
  for (;;) {
    now = source.advance();
    model.tick(now);
    const double waited = to_seconds(bus::mono_us() - begin);
    if (stop_flag || source.at_end()) break;
    const bool answered =
        !model.pairs().empty() && std::all_of(model.pairs().begin(), model.pairs().end(),
                                              [](const PairState& p) { return p.answer() != nullptr; });
    // after this time each process has sent a heartbeat, one a second
    if (source.live() && ((answered && waited > 1.2) || waited > options.timeout_s)) break;
    source.wait(20);
  }
  if (!options.size.empty()) {
    ViewState view = first_view(options, source);
    view.charset = charset;
    view.network_error = source.network_error();
    const Size size = size_from_text(options.size).value_or(Size{});
    Canvas canvas(size.width, size.height);
    draw(canvas, model, view);
    static_cast<void>(print(canvas.to_text()));
  } else {
    static_cast<void>(print(options.json ? json_line(model) + "\n" : text_lines(model, charset)));
  }
  if (!stop_flag) require_messages(model, source);
  return 0;
}

int run_follow(const ProgramOptions& options, Model& model, Source& source, Charset charset) {
  handle_stop();
  const std::int64_t begin = bus::mono_us();
  const int offset = utc_offset_s();
  std::int64_t printed_us = 0;
  std::int64_t printed_messages = -1;
  std::int64_t printed_events = 0;
  for (;;) {
    const Now now = source.advance();
    model.tick(now);
    const std::int64_t mono = bus::mono_us();
    const bool over =
        stop_flag || source.at_end() ||
        (options.duration_s > 0 && static_cast<double>(mono - begin) * 1e-6 > options.duration_s);
    if (!options.json) {
      const auto& events = model.events();
      const std::int64_t fresh = std::min<std::int64_t>(model.events_seen() - printed_events,
                                                        static_cast<std::int64_t>(events.size()));
      printed_events = model.events_seen();
      for (std::size_t i = events.size() - static_cast<std::size_t>(fresh); i < events.size(); ++i)
        if (!print(event_line(events[i], offset) + "\n")) return 0;
    }
    if ((mono - printed_us >= 1000000 || over) && model.messages() != printed_messages) {
      printed_us = mono;
      printed_messages = model.messages();
      std::string text = options.json ? json_line(model) + "\n" : pair_lines(model, charset);
      if (over && !options.json) text = text_lines(model, charset);
      if (!print(text)) return 0;
    }
    if (over && !stop_flag) require_messages(model, source);
    if (over) return 0;
    source.wait(50);
  }
}

}  // namespace egocal::monitor
