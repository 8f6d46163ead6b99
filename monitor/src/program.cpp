// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <langinfo.h>
#include <poll.h>
#include <unistd.h>

#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/view.hpp"
#include "feed.hpp"
#include "recording.hpp"
#include "terminal.hpp"

namespace egocal::monitor {
namespace {

constexpr int most_exports = 10'000;  // a limit: of one pair and format in one folder

volatile std::sig_atomic_t stop_flag = 0;
extern "C" void on_stop(int) {
  stop_flag = 1;
}

int utc_offset_s() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return static_cast<int>(local.tm_gmtoff);
}

// Messages from the bus or from a log, behind one face.
class Source {
 public:
  Source(Model& model, const ProgramOptions& options, const std::string& url,
         const std::vector<bus::Sensor>& sensors) {
    if (options.log.empty()) {
      feed_ = std::make_unique<Feed>(
          model, FeedOptions{url, options.version, model.options().heartbeat_timeout, sensors});
      name_ = url.substr(0, url.find('?'));
    } else {
      recording_ = std::make_unique<Recording>(model, options.log, options.speed);
      name_ = "log " + std::filesystem::path(options.log).filename().string();
    }
  }
  bool live() const { return feed_ != nullptr; }
  bool at_end() const { return recording_ && recording_->at_end(); }
  const std::string& name() const { return name_; }
  std::string network_error() const { return feed_ ? feed_->network_error() : std::string(); }

  /// wait() also returns when one of these is readable.
  void watch(std::vector<int> fds) {
    if (feed_) feed_->watch(fds);
    fds_ = std::move(fds);
  }
  /// Waits at most this long [ms]. Live messages are handed to the model at once.
  void wait(int milliseconds) {
    if (feed_) {
      feed_->wait(milliseconds);
      return;
    }
    std::vector<pollfd> fds;
    for (const int fd : fds_) fds.push_back({fd, POLLIN, 0});
    poll(fds.data(), fds.size(), milliseconds);
  }
  /// Delivers what is due of a log; the time of the model.
  Now advance() { return recording_ ? recording_->advance(bus::mono_us()) : feed_->now(); }
  /// The reason why it could not be sent; empty: sent.
  std::string send(const command_t& command) {
    return !feed_ || feed_->send(command) ? std::string{} : feed_->error();
  }

 private:
  std::unique_ptr<Feed> feed_;
  std::unique_ptr<Recording> recording_;
  std::string name_;
  std::vector<int> fds_;
};

/// Writes it under a name that no file has, so that no earlier export is overwritten. The name.
std::string write_export(const std::string& a, const std::string& b, ExtrinsicFormat format,
                         const std::string& text) {
  const char* ending = format == ExtrinsicFormat::urdf     ? ".urdf"
                       : format == ExtrinsicFormat::ros    ? ".ros.sh"
                       : format == ExtrinsicFormat::kalibr ? ".kalibr.yaml"
                                                           : ".yaml";
  std::string stem = "extrinsic_";
  for (char c : a.substr(0, 40) + "_" + b.substr(0, 40)) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    stem += plain ? c : '_';
  }
  std::string file = stem + ending;
  for (int i = 2; !write_new_file(file, text); ++i) {
    if (i == most_exports) throw Error(stem + ending + ": too many files of this name are here; remove some");
    file = stem + "-" + std::to_string(i) + ending;
  }
  return file;
}

const PairState* pair_of(const Model& model, const Action& action) {
  for (const PairState& pair : model.pairs())
    if (pair.a == action.a && pair.b == action.b) return &pair;
  return nullptr;
}

void carry_out(const Action& action, const Model& model, ViewState& view, Source& source) {
  if (action.kind == Action::Kind::export_answer) {
    const PairState* pair = pair_of(model, action);
    const std::optional<NamedExtrinsic> extrinsic = pair ? extrinsic_of(*pair) : std::nullopt;
    if (!extrinsic) {
      view.notice = "there is no answer to export yet";
      return;
    }
    try {
      const std::string file =
          write_export(action.a, action.b, action.format, extrinsic_text(*extrinsic, action.format));
      view.notice = "wrote " + file +
                    (pair->old > 0          ? " (an old answer: not to be used)"
                     : extrinsic->certified ? ""
                                            : " (not certified)");
    } catch (const Error& error) {
      view.notice = error.what();
    }
    return;
  }
  command_t command{};
  command.utime = bus::wall_us();
  command.to = "*";
  command.verb = action.kind == Action::Kind::reset   ? "reset"
                 : action.kind == Action::Kind::pause ? "pause"
                                                      : "resume";
  command.sensor_a = action.a;
  command.sensor_b = action.b;
  if (action.kind == Action::Kind::reset) command.session = action.session;
  const std::string error = source.send(command);
  view.notice = error.empty() ? command.verb + " sent" : "not sent: " + error;
}

std::string no_session(const std::string& log) {
  return log + " holds nothing of egocal's processes, odometry at most: `egocal up RIG --log` plays it";
}

Screen screen_from(const std::string& name) {
  return name == "detail"    ? Screen::detail
         : name == "events"  ? Screen::events
         : name == "streams" ? Screen::streams
                             : Screen::overview;
}

ViewState first_view(const ProgramOptions& options, const Source& source) {
  ViewState view;
  view.screen = screen_from(options.screen);
  view.source = source.name();
  view.live = source.live();
  view.utc_offset_s = utc_offset_s();
  return view;
}

int run_terminal(const ProgramOptions& options, Model& model, Source& source,
                 std::unique_ptr<Terminal> terminal) {
  ViewState view = first_view(options, source);
  view.charset = terminal->charset();
  source.watch(terminal->fds());
  std::optional<Model> still;  // what is shown while the view is paused
  const std::int64_t begin = bus::mono_us();
  std::int64_t drained = 0, drawn = 0, ticked = 0, noticed = 0;
  bool changed = true;
  for (;;) {
    const std::int64_t next = std::min(drained + options.drain_us,
                                       changed ? drawn + options.redraw_us / 4 : drawn + options.redraw_us);
    source.wait(static_cast<int>(std::clamp<std::int64_t>((next - bus::mono_us() + 999) / 1000, 0, 100)));
    const Interrupts interrupts = terminal->interrupts();
    if (interrupts.quit) return 0;
    if (interrupts.resized) changed = true;

    std::int64_t mono = bus::mono_us();
    if (mono - drained >= options.drain_us) {
      drained = mono;
      const Now now = source.advance();
      for (const std::string& line : terminal->captured()) model.note(Severity::warning, "stderr", line, now);
      if (mono - ticked >= options.tick_us) {
        ticked = mono;
        model.tick(now);
        if (source.at_end() && model.messages() == 0)
          view.notice = no_session(source.name());
        else if (mono - noticed > options.notice_us)
          view.notice.clear();
      }
    }
    while (const auto key = terminal->key()) {
      const Model& seen = still ? *still : model;
      const Action action = press(view, seen, *key);
      if (action.kind == Action::Kind::quit) return 0;
      if (action.kind != Action::Kind::none) carry_out(action, seen, view, source);
      noticed = mono;
      if (view.frozen && !still) still = model;
      if (!view.frozen) still.reset();
      changed = true;
    }
    if (options.duration_s > 0 && static_cast<double>(mono - begin) * 1e-6 > options.duration_s) return 0;

    mono = bus::mono_us();
    if (mono - drawn >= options.redraw_us || (changed && mono - drawn >= options.redraw_us / 4)) {
      drawn = mono;
      changed = false;
      view.width = terminal->width();
      view.height = terminal->height();
      view.network_error = source.network_error();
      Canvas canvas(view.width, view.height);
      draw(canvas, still ? *still : model, view);
      terminal->show(canvas);
    }
  }
}

/// False: the reader has seen enough and has gone. Throws Error where the output cannot be written otherwise.
bool print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  if (errno == EPIPE) return false;
  throw Error(std::string("standard output: cannot be written: ") + std::strerror(errno));
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
  throw Error(source.live() ? "nothing received on " + source.name() : no_session(source.name()));
}

int run_once(const ProgramOptions& options, Model& model, Source& source, Charset charset) {
  handle_stop();
  const std::int64_t begin = bus::mono_us();
  Now now;
  for (;;) {
    now = source.advance();
    model.tick(now);
    const double waited = static_cast<double>(bus::mono_us() - begin) * 1e-6;
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

}  // namespace

int run(const ProgramOptions& options) {
  std::setlocale(LC_CTYPE, "");
  if (!options.size.empty() && !size_from_text(options.size)) {
    std::fprintf(stderr, "egocal-monitor: --size: expected WIDTHxHEIGHT, e.g. 100x30, got '%s'\n",
                 clean(options.size, 40).c_str());
    return 2;
  }
  ModelOptions model_options;
  if (options.log.empty()) {
    model_options.own_host = bus::host_name();
    model_options.own_pid = static_cast<std::int32_t>(getpid());
  }
  std::optional<bus::Rig> rig;
  std::string url = bus::Rig().lcm_url;
  if (!options.rig.empty()) {
    rig = bus::read_rig(options.rig);
    model_options.heartbeat_timeout = rig->heartbeat_timeout;
    model_options.max_gap = rig->max_gap;
    url = rig->lcm_url;
  }
  if (!options.lcm_url.empty()) url = options.lcm_url;
  Model model(model_options);
  if (rig)
    for (const bus::PairConfig& pair : rig->pairs) model.expect_pair(pair.a, pair.b);
  Source source(model, options, url, rig ? rig->sensors : std::vector<bus::Sensor>());

  const bool utf8 = std::string_view(nl_langinfo(CODESET)) == "UTF-8";
  const Charset charset = utf8 && !options.ascii ? Charset::unicode : Charset::ascii;
  if (options.once) return run_once(options, model, source, charset);
  if (options.follow) return run_follow(options, model, source, charset);
  TerminalOptions terminal_options;
  if (options.ascii) terminal_options.charset = Charset::ascii;
  terminal_options.monochrome = options.monochrome;
  std::string why_not;
  if (std::unique_ptr<Terminal> terminal = Terminal::open(terminal_options, why_not)) {
    const int code = run_terminal(options, model, source, std::move(terminal));
    static_cast<void>(
        print(pair_lines(model, charset)));  // the answer stays on the screen when the monitor has gone
    return code;
  }
  std::fprintf(stderr, "egocal-monitor: %s: printing lines instead\n", why_not.c_str());
  return run_follow(options, model, source, charset);
}

}  // namespace egocal::monitor
