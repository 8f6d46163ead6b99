// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/layout.hpp"
#include "egocal/monitor/view.hpp"
#include "event_list.hpp"
#include "panels.hpp"
#include "selection.hpp"

namespace egocal::monitor {
namespace {

constexpr std::array<double, 6> window_choices{10, 30, 60, 300, 1800, 7200};  // [s]

/// Measured time that the curves of a pair cover [s].
double session_length(const PairState* pair) {
  const calibration_t* answer = pair ? pair->answer() : nullptr;
  return answer ? seconds_between(pair->session, answer->utime) : 0;
}

/// step > 0: shows less of the session. The choices are the windows shorter than the session, and all of it.
void zoom(ViewState& view, const Model& model, int step) {
  const double length = session_length(selected_pair(model, view));
  std::vector<double> windows;
  for (const double window : window_choices)
    if (window < length || window == window_choices.front() || window == view.window_s)
      windows.push_back(window);
  windows.push_back(0);  // all
  auto at = std::find(windows.begin(), windows.end(), view.window_s);
  if (step > 0 && at != windows.begin()) --at;
  if (step < 0 && at + 1 != windows.end()) ++at;
  view.window_s = *at;
  view.notice = view.window_s == 0 ? "the curves show the whole session"
                                   : "the curves show the last " + age(view.window_s);
}

Action about_pair(Action::Kind kind, const PairState& pair) {
  Action action;
  action.kind = kind;
  action.a = pair.a;
  action.b = pair.b;
  action.session = pair.session;
  return action;
}

Action press_in_dialog(ViewState& view, const Model& model, KeyPress key) {
  const Dialog dialog = view.dialog;
  view.dialog = Dialog::none;
  const PairState* pair = selected_pair(model, view);
  const char c = key.key == Key::character ? key.character : '\0';
  if (dialog == Dialog::help || !pair) return {};
  if (dialog == Dialog::export_format) {
    constexpr ExtrinsicFormat formats[] = {ExtrinsicFormat::yaml, ExtrinsicFormat::ros, ExtrinsicFormat::urdf,
                                           ExtrinsicFormat::kalibr};
    for (ExtrinsicFormat format : formats)
      if (c == to_string(format)[0]) {
        Action action = about_pair(Action::Kind::export_answer, *pair);
        action.format = format;
        return action;
      }
    view.notice = "nothing exported";
    return {};
  }
  if (c == 'y' || c == 'Y') {
    return about_pair(dialog == Dialog::reset   ? Action::Kind::reset
                      : dialog == Dialog::pause ? Action::Kind::pause
                                                : Action::Kind::resume,
                      *pair);
  }
  view.notice = "nothing done";
  return {};
}

void ask(ViewState& view, const Model& model, Dialog dialog) {
  if (!selected_pair(model, view)) {
    view.notice = "there is no pair yet";
  } else if (!view.live && dialog != Dialog::export_format) {
    view.notice = "this is a log: there is no process to command";
  } else {
    view.dialog = dialog;
  }
}

/// Moves the selection on the overview and the detail, the lines of a list on the other screens.
class Cursor {
 public:
  Cursor(ViewState& view, const Model& model)
      : view_(view),
        model_(model),
        pairs_(static_cast<int>(model.pairs().size())),
        page_(event_rows(layout_events(80, view.height).list.h)),
        list_(view.screen == Screen::events || view.screen == Screen::streams) {}

  void up() { list_ ? scroll(1) : select(view_.selected - 1); }
  void down() { list_ ? scroll(-1) : select(view_.selected + 1); }
  void page_up() { list_ ? scroll(page_) : select(view_.selected - 10); }
  void page_down() { list_ ? scroll(-page_) : select(view_.selected + 10); }
  void home() { list_ ? scroll(lines()) : select(0); }
  void end() { list_ ? scroll(-lines()) : select(pairs_ - 1); }
  /// Selects the next pair or the one before, cyclically.
  void next(int step) { select(pairs_ ? (view_.selected + pairs_ + step) % pairs_ : 0); }

 private:
  void select(int index) { view_.selected = pairs_ ? std::clamp(index, 0, pairs_ - 1) : 0; }
  int lines() const {
    return view_.screen == Screen::streams ? stream_line_count(model_, view_.width)
                                           : event_line_count(model_, view_.width, view_.charset);
  }
  void scroll(int step) {
    // the newest event is at the bottom, the first stream at the top
    const int up = view_.screen == Screen::streams ? -step : step;
    view_.scroll = std::clamp(view_.scroll + up, 0, std::max(0, lines() - page_));
  }

  ViewState& view_;
  const Model& model_;
  int pairs_, page_;
  bool list_;
};

void show(ViewState& view, Screen screen) {
  view.screen = screen;
  if (screen == Screen::events || screen == Screen::streams) view.scroll = 0;
}

void press_special(ViewState& view, Cursor cursor, Key key) {
  switch (key) {
    case Key::up:
      return cursor.up();
    case Key::down:
      return cursor.down();
    case Key::page_up:
      return cursor.page_up();
    case Key::page_down:
      return cursor.page_down();
    case Key::home:
      return cursor.home();
    case Key::end:
      return cursor.end();
    case Key::enter:
    case Key::right:
      if (view.screen == Screen::overview) view.screen = Screen::detail;
      return;
    case Key::escape:
    case Key::left:
      view.screen = Screen::overview;
      return;
    case Key::tab:
      view.screen = view.screen == Screen::overview ? Screen::detail
                    : view.screen == Screen::detail ? Screen::events
                                                    : Screen::overview;
      return;
    case Key::character:
      return;
  }
}

/// Keys that change the view. False: this is none of them.
bool press_to_show(ViewState& view, const Model& model, Cursor cursor, char character) {
  switch (character) {
    case '?':
    case 'h':
      view.dialog = Dialog::help;
      return true;
    case 'k':
      cursor.up();
      return true;
    case 'j':
      cursor.down();
      return true;
    case 'n':
      cursor.next(1);
      return true;
    case 'N':
      cursor.next(-1);
      return true;
    case '1':
      show(view, Screen::overview);
      return true;
    case '2':
      show(view, Screen::detail);
      return true;
    case '3':
    case 'e':
      show(view, Screen::events);
      return true;
    case '4':
    case 's':
      show(view, Screen::streams);
      return true;
    case '+':
    case '=':
      zoom(view, model, 1);
      return true;
    case '-':
      zoom(view, model, -1);
      return true;
    case 'l':
      view.logarithmic = !view.logarithmic;
      view.notice = view.logarithmic ? "logarithmic axes" : "linear axes";
      return true;
    case ' ':
      view.frozen = !view.frozen;
      return true;
    default:
      return false;
  }
}

/// Keys that open a question before a command is sent or a file is written.
void press_to_ask(ViewState& view, const Model& model, char character) {
  if (character == 'r') ask(view, model, Dialog::reset);
  if (character == 'x') ask(view, model, Dialog::export_format);
  if (character != 'p') return;
  const PairState* pair = selected_pair(model, view);
  ask(view, model, pair && pair_is_paused(model, *pair) ? Dialog::resume : Dialog::pause);
}

}  // namespace

Action press(ViewState& view, const Model& model, KeyPress key) {
  view.notice.clear();
  if (view.dialog != Dialog::none) return press_in_dialog(view, model, key);
  const Cursor cursor(view, model);
  Action action;
  if (key.key != Key::character)
    press_special(view, cursor, key.key);
  else if (key.character == 'q' || key.character == 'Q')
    action.kind = Action::Kind::quit;
  else if (!press_to_show(view, model, cursor, key.character))
    press_to_ask(view, model, key.character);
  return action;
}

}  // namespace egocal::monitor
