// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/provenance.hpp"

#include "egocal/bus/plausible.hpp"
#include "egocal/version.hpp"

namespace egocal::tools {

namespace {

using nlohmann::ordered_json;

const char* order_text(QuaternionOrder order) {
  switch (order) {
    case QuaternionOrder::wxyz:
      return "wxyz";
    case QuaternionOrder::xyzw:
      return "xyzw";
    case QuaternionOrder::as_read:
      break;
  }
  return "as the format says";
}

ordered_json reading_json(const Reading& reading) {
  return {{"invert", reading.invert}, {"quaternion_order", order_text(reading.quaternion_order)}};
}

}  // namespace

ordered_json provenance_json(const std::string& command_line) {
  return {
      {"schema", json_schema}, {"version", version()}, {"command", bus::printable(command_line, 100'000)}};
}

ordered_json files_json(const std::vector<std::pair<std::string, std::string>>& role_and_name) {
  ordered_json files = ordered_json::array();
  for (const auto& [role, name] : role_and_name)
    if (!name.empty()) files.push_back({{"role", role}, {"name", bus::printable(name, 4096)}});
  return files;
}

ordered_json files_json(const SolveRequest& request) {
  const MotionSource& source = request.source;
  std::vector<std::pair<std::string, std::string>> files{{"log", source.log},
                                                         {"a", source.a},
                                                         {"b", source.b},
                                                         {"pairs", source.pairs},
                                                         {"times_a", source.reading_a.times_file},
                                                         {"times_b", source.reading_b.times_file}};
  for (const std::string& file : request.append) files.emplace_back("append", file);
  return files_json(files);
}

ordered_json settings_json(const SolveRequest& request) {
  const CalibrationOptions& options = request.calibration;
  const PairingOptions& pairing = options.pairing;
  ordered_json json;
  json["method"] = request.method;
  json["mode"] = pairing.mode == Mode::planar ? "planar" : "spatial";
  json["stride"] = pairing.stride ? ordered_json(*pairing.stride) : ordered_json("auto");
  json["weights"] = "auto";
  if (pairing.balance)
    json["weights"] = {{"rotation", pairing.balance->rotation},
                       {"translation", pairing.balance->translation}};
  json["reject_outliers"] = pairing.robust;
  json["time_offset"] =
      options.estimate_time_offset ? ordered_json("auto") : ordered_json(pairing.time_offset);
  json["max_gap_s"] = pairing.max_gap;
  json["scale"] = options.estimate_scale ? ordered_json("auto") : ordered_json(options.scale);
  json["scale_of"] = options.scale_side == Side::a ? "a" : "b";
  json["read_a"] = reading_json(options.read_a);
  json["read_b"] = reading_json(options.read_b);
  return json;
}

void append_json(ordered_json& json, const ordered_json& more) {
  for (const auto& [key, value] : more.items())
    if (!json.contains(key)) json[key] = value;
}

}  // namespace egocal::tools
