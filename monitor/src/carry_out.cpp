// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "carry_out.hpp"

#include <optional>
#include <string>

#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal::monitor {

namespace {

constexpr int most_exports = 10'000;  // a limit: of one pair and format in one folder

/// Writes an export under a name that no file has, so that no earlier one is overwritten. Returns the name.
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

}  // namespace

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
      // before the name, which may be longer than the screen is wide
      view.notice = std::string(pair->old > 0          ? "an old answer, not to be used: "
                                : !extrinsic->usable   ? "not to be used: "
                                : extrinsic->certified ? ""
                                                       : "not certified: ") +
                    "wrote " + file;
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

}  // namespace egocal::monitor
