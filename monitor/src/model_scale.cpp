// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model handles a scale that is found together with the extrinsic.
#include <optional>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

/// Whether the scale is shown by the motions, with a proof of this monitor's own.
bool shown(const std::optional<bus::CheckedScale>& scale) {
  return scale && scale->verified && scale->solution.certified && scale->solution.observable;
}

}  // namespace

void Model::on_scale(const scale_t& message, const bus::CheckedScale& scale, Now now) {
  now_ = now;
  ++messages_;
  PairState* pair = find_pair(message.sensor_a, message.sensor_b);
  if (!pair || (pair->has_problem && scale.session < pair->session)) return;
  if (scale.session != pair->session) {
    if (pair->has_problem) note_new_session(*pair, scale.session, now);
    begin_session(*pair, scale.session);
    pair->has_problem = false;  // its problem comes once the scale is known
  }
  if (pair->scale && pair->scale->seq > scale.seq) return;  // overtaken on the way
  if (pair->scale ? shown(scale) != shown(pair->scale) : shown(scale))
    note(shown(scale) ? Severity::good : Severity::warning, pair_name(pair->a, pair->b),
         shown(scale) ? "the scale of " + scale.sensor + " is known"
                      : "the motions no longer show the scale of " + scale.sensor,
         now);
  pair->scale = scale;
}

}  // namespace egocal::monitor
