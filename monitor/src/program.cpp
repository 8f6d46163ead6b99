// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <langinfo.h>
#include <unistd.h>

#include <clocale>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/view.hpp"
#include "printed_lines.hpp"
#include "source.hpp"
#include "terminal.hpp"
#include "terminal_loop.hpp"

namespace egocal::monitor {

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
    // the answer stays on the screen when the monitor has gone
    static_cast<void>(print(pair_lines(model, charset)));
    return code;
  }
  std::fprintf(stderr, "egocal-monitor: %s: printing lines instead\n", why_not.c_str());
  return run_follow(options, model, source, charset);
}

}  // namespace egocal::monitor
