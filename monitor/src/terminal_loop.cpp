// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "terminal_loop.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "carry_out.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/monitor/view.hpp"
#include "first_view.hpp"
#include "selection.hpp"

namespace egocal::monitor {

namespace {

/// A view that is paused shows the calibration of then; what is asked is about that of now.
void ask_of_the_present(ViewState& view, const Model& seen, const Model& model) {
  if (view.dialog != Dialog::pause && view.dialog != Dialog::resume) return;
  const PairState* pair = selected_pair(seen, view);
  for (const PairState& now : model.pairs())
    if (pair && now.a == pair->a && now.b == pair->b)
      view.dialog = pair_is_paused(model, now) ? Dialog::resume : Dialog::pause;
}

}  // namespace

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
          view.notice = source.nothing_in_words();
        else if (mono - noticed > options.notice_us)
          view.notice.clear();
      }
    }
    while (const auto key = terminal->key()) {
      const Model& seen = still ? *still : model;
      const Action action = press(view, seen, *key);
      ask_of_the_present(view, seen, model);
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

}  // namespace egocal::monitor
