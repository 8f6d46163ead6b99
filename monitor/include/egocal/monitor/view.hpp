// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/io/extrinsic_text.hpp"
#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

enum class Screen { overview, detail, events, streams };
enum class Dialog { none, help, reset, pause, resume, export_format };

/// What the person at the keyboard has chosen.
struct ViewState {
  Screen screen = Screen::overview;
  Dialog dialog = Dialog::none;
  int selected = 0;     ///< pair
  double window_s = 0;  ///< time shown by the curves up to now; 0: all
  bool logarithmic = true;
  bool frozen = false;          ///< the view is frozen, the calibration continues
  int scroll = 0;               ///< events: lines up from the newest
  int width = 80, height = 24;  ///< of the screen: how far lists can be scrolled
  std::string notice;           ///< one line for the bottom: the outcome of the last key
  std::string source;           ///< where the messages come from
  std::string network_error{};  ///< why nothing comes from there; empty: the network is there
  bool live = true;             ///< false: a log; there is no process to send commands to
  Charset charset = Charset::ascii;
  int utc_offset_s = 0;
};

enum class Key { character, up, down, left, right, page_up, page_down, home, end, enter, escape, tab };
struct KeyPress {
  Key key = Key::character;
  char character = 0;
};

/// What a key asks of the program; the view's own affairs are settled in the ViewState.
struct Action {
  enum class Kind { none, quit, reset, pause, resume, export_answer } kind = Kind::none;
  std::string a, b;          ///< the pair meant
  std::int64_t session = 0;  ///< reset: only this one
  ExtrinsicFormat format = ExtrinsicFormat::yaml;
};
/// Pure: the same state, model and key give the same result.
Action press(ViewState& view, const Model& model, KeyPress key);

/// Draws everything, whatever the canvas' size.
void draw(Canvas& canvas, const Model& model, const ViewState& view);

/// The answer of a pair for export; empty where there is none that could be used.
std::optional<NamedExtrinsic> extrinsic_of(const PairState& pair);

}  // namespace egocal::monitor
