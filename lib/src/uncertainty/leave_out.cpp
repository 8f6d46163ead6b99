// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/uncertainty/leave_out.hpp"

#include "egocal/solvers/global.hpp"
#include "problem/without_part.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal {

using detail::Vector6d;

namespace {

std::vector<Vector6d> planar_differences(const Problem& problem, const DualQuaternion& T_a_b) {
  std::vector<Vector6d> differences;
  const Statistics all = sum_blocks(problem.blocks);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const Pose with_all = to_pose(T_a_b);
  for (const Statistics& block : problem.blocks) {
    if (detail::takes_off(block)) continue;
    const Solution without = solve_planar(cost_matrix(detail::without_part(all, block), problem.balance));
    differences.push_back(detail::frame_a_difference(with_all, extrinsic_from_planar(without.q, G_a, G_b)));
  }
  return differences;
}

std::vector<Vector6d> spatial_differences(const Problem& problem, const Matrix8d& Q,
                                          const DualQuaternion& T_a_b) {
  const double length = detail::length_scale(Q);
  const DualQuaternion q = detail::in_units_of(length, T_a_b);
  const detail::TangentSpace space(q, length, detail::frame_a_basis(q), problem.balance);
  detail::TangentForm all;
  std::vector<detail::FourForms> forms;
  std::size_t count = 0;
  for (const Statistics& block : problem.blocks) {
    const detail::TangentForm form = space.form(block);
    all += form;
    if (detail::takes_off(block)) continue;
    const std::size_t place = count++ % detail::FourForms::count;
    if (place == 0) forms.emplace_back();
    // until others come
    for (std::size_t k = place; k < detail::FourForms::count; ++k) forms.back().set(k, form);
  }
  std::vector<Vector6d> differences(count);
  for (std::size_t i = 0; i < count; i += detail::FourForms::count) {
    const auto steps = detail::TangentSpace::newton_steps_without(all, forms[i / detail::FourForms::count]);
    for (std::size_t k = 0; k < detail::FourForms::count && i + k < count; ++k)
      differences[i + k] = detail::column(steps, k);
  }
  for (Vector6d& difference : differences) difference.head<3>() *= length;
  return differences;
}

}  // namespace

std::vector<Vector6d> leave_out_differences(const Problem& problem, const Matrix8d& Q_metres,
                                            const DualQuaternion& T_a_b) {
  return problem.mode == Mode::planar ? planar_differences(problem, T_a_b)
                                      : spatial_differences(problem, Q_metres, T_a_b);
}

}  // namespace egocal
