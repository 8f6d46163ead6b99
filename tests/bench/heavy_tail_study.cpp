// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What KITTI 0930_27 holds in 3-D: maximum likelihood with Student's t noise of three degrees of freedom on
// every step, with either stream interpolated and with both problems together: its error, and the profile of
// the likelihood along each coordinate of the translation. Two tables of docs/accuracy.md.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/pairing/synchroniser.hpp"
#include "egocal/solvers/global.hpp"
#include "markdown_tables.hpp"
#include "support/real_drives.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;
using testing::Streams;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double freedom = 3;     ///< of Student's t
constexpr double dimensions = 3;  ///< of a rotation, of a translation
constexpr int rounds = 30;
constexpr std::size_t spans = 20;   ///< that are omitted in turn
constexpr double longest_step = 1;  ///< [s]

struct Step {
  Matrix8d dual_rows;
  double time = 0;                       ///< part of the drive
  double rotation = 1, translation = 1;  ///< weights [1/rad^2, 1/m^2]

  Matrix8d cost() const {
    Matrix8d Q = translation * dual_rows;
    Q.topLeftCorner<4, 4>() += rotation * dual_rows.bottomRightCorner<4, 4>();
    return Q;
  }
};
using Steps = std::vector<Step>;

/// The other stream is interpolated at the stamps of `clock`.
Steps steps_of(const Streams& streams, Side clock) {
  PairingOptions options = streams.options;
  options.synchroniser.slower_by = clock == Side::a ? 1e-6 : 1e6;
  Synchroniser synchroniser(options);
  std::vector<Instant> instants;
  std::size_t i = 0, j = 0;
  while (i < streams.a.size() || j < streams.b.size()) {
    const bool from_a =
        j == streams.b.size() || (i < streams.a.size() && streams.a[i].time_us <= streams.b[j].time_us);
    const StampedPose& pose = from_a ? streams.a[i++] : streams.b[j++];
    for (const Instant& instant : synchroniser.push(from_a ? Side::a : Side::b, pose))
      instants.push_back(instant);
  }
  Steps steps;
  const auto first = static_cast<double>(instants.front().time_us);
  const double length = static_cast<double>(instants.back().time_us) - first;
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const Instant &from = instants[k - 1], &to = instants[k];
    if (static_cast<double>(to.time_us - from.time_us) > 1e6 * longest_step) continue;
    Statistics step;
    step.add(motion_between(from.a, to.a), motion_between(from.b, to.b));
    steps.push_back({step.dual_rows, (static_cast<double>(from.time_us) - first) / length});
  }
  return steps;
}

struct Squares {
  std::vector<double> rotation, translation;  ///< of the residuals, one a step [rad^2, m^2]
};

Squares squares_of(const Steps& steps, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  Squares squares;
  for (const Step& step : steps) {
    squares.rotation.push_back(q.real.dot(step.dual_rows.bottomRightCorner<4, 4>() * q.real));
    squares.translation.push_back(v.dot(step.dual_rows * v));
  }
  return squares;
}

/// Scale of Student's t by expectation and maximisation: the mean square of weighted residuals.
double scale_of(const std::vector<double>& squares) {
  double scale = 0;
  for (const double square : squares) scale += square / static_cast<double>(squares.size());
  for (int round = 0; round < rounds; ++round) {
    double sum = 0;
    for (const double square : squares)
      sum += (freedom + dimensions) * square / (freedom + dimensions * square / scale);
    scale = sum / static_cast<double>(squares.size());
  }
  return scale;
}

void weigh(Steps& steps, const DualQuaternion& q) {
  const auto [rotation, translation] = squares_of(steps, q);
  const double rotation_scale = scale_of(rotation), translation_scale = scale_of(translation);
  const auto weight = [](double square, double scale) {
    return (freedom + dimensions) / (freedom + dimensions * square / scale) * dimensions / scale;
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i].rotation = weight(rotation[i], rotation_scale);
    steps[i].translation = weight(translation[i], translation_scale);
  }
}

/// -2 log likelihood at q, but for a constant, at the likeliest scales.
double minus_two_log_likelihood(const std::vector<Steps>& problems, const DualQuaternion& q) {
  double sum = 0;
  for (const Steps& steps : problems) {
    const Squares squares = squares_of(steps, q);
    for (const std::vector<double>* component : {&squares.rotation, &squares.translation}) {
      const double scale = scale_of(*component);
      for (const double square : *component)
        sum += dimensions * std::log(scale) +
               (freedom + dimensions) * std::log1p(dimensions * square / (freedom * scale));
    }
  }
  // two problems on the same data are no more than one of them
  return sum / static_cast<double>(problems.size());
}

/// The likeliest extrinsic whose translation along `axis` is `value` [m], by Gauss-Newton steps from `near`.
DualQuaternion likeliest_with(std::vector<Steps> problems, const DualQuaternion& near, Eigen::Index axis,
                              double value) {
  Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
  step[axis] = value - to_pose(near).translation[axis];
  DualQuaternion q = detail::frame_a_moved(near, step);
  for (int round = 0; round < rounds; ++round) {
    Matrix8d Q = Matrix8d::Zero();
    for (Steps& steps : problems) {
      weigh(steps, q);
      for (const Step& one : steps) Q += one.cost();
    }
    const auto basis = detail::frame_a_basis(q);
    Eigen::Matrix<double, 6, 6> H = basis.transpose() * Q * basis;
    Eigen::Matrix<double, 6, 1> gradient = basis.transpose() * Q * q.vec();
    H.row(axis).setZero();
    H.col(axis).setZero();
    H(axis, axis) = 1;
    gradient[axis] = 0;
    q = detail::frame_a_moved(q, -H.ldlt().solve(gradient));
  }
  return q;
}

struct Estimate {
  DualQuaternion T;
  std::array<double, 6> left_out{}, curvature{};  ///< standard deviations
};

Estimate estimate(std::vector<Steps> problems) {
  Matrix8d Q;
  DualQuaternion q;
  for (int round = 0; round < rounds; ++round) {
    Q.setZero();
    for (const Steps& steps : problems)
      for (const Step& step : steps) Q += step.cost();
    q = solve_dual(Q).q;
    for (Steps& steps : problems) weigh(steps, q);
  }
  Estimate result{q, {}, {}};
  const auto basis = detail::frame_a_basis(q);
  const Eigen::Matrix<double, 6, 6> covariance = (basis.transpose() * Q * basis).inverse();
  std::array<Matrix8d, spans> parts;
  parts.fill(Matrix8d::Zero());
  for (const Steps& steps : problems)
    for (const Step& step : steps)
      parts[std::min(spans - 1, static_cast<std::size_t>(step.time * spans))] += step.cost();
  std::vector<Eigen::Matrix<double, 6, 1>> differences;
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Matrix8d& part : parts) {
    differences.emplace_back(detail::frame_a_difference(q, solve_dual(Q - part).q));
    mean += differences.back() / static_cast<double>(spans);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    double sum = 0;
    for (const auto& difference : differences) sum += std::pow(difference[k] - mean[k], 2);
    result.left_out[i] = std::sqrt(sum * (spans - 1) / spans);
    // two problems on the same data are no more than one of them
    result.curvature[i] = std::sqrt(covariance(k, k) * static_cast<double>(problems.size()));
  }
  return result;
}

std::string three(const char* format, double x, double y, double z) {
  char text[96];
  std::snprintf(text, sizeof text, format, x, y, z);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::string write, check;
  egocal::cli::Program app("heavy_tail_study",
                           "What KITTI 0930_27 holds in 3-D: two tables of docs/accuracy.md");
  app.add_option("--write", write, "a page: put the tables in their places");
  app.add_option("--check", check, "a page: exit 1 where its tables differ");
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!testing::have_real_drives()) {
    std::printf("the data in %s are not here\n", paths::data_dir().c_str());
    return bench::not_compared;
  }
  const Streams streams = testing::kitti_asynchronous();
  const Steps by_camera = steps_of(streams, Side::b), by_lidar = steps_of(streams, Side::a);
  bench::Table table{"heavy-tails",
                     {{"interpolated", "error", "of x, y, z", "standard deviation of x, y, z, spans omitted",
                       "by the curvature of the likelihood"}}};
  bench::Table profile{"profile",
                       {{"interpolated", "x, y, z at the truth, each alone", "z 10 cm lower, higher",
                         "z 20 cm lower, higher", "z 26 cm too high"}}};
  const auto add = [&](const char* name, const std::vector<Steps>& problems) {
    const Estimate found = estimate(problems);
    const double most_likely = minus_two_log_likelihood(problems, found.T);
    const auto lost_at = [&](Eigen::Index axis, double value) {
      return minus_two_log_likelihood(problems, likeliest_with(problems, found.T, axis, value)) - most_likely;
    };
    const Eigen::Vector3d truth = to_pose(streams.T).translation;
    const double z = to_pose(found.T).translation.z();
    const auto two = [](double lower, double higher) {
      char text[64];
      std::snprintf(text, sizeof text, "%.1f, %.1f", lower, higher);
      return std::string(text);
    };
    char too_high[32];
    std::snprintf(too_high, sizeof too_high, "%.1f", lost_at(2, truth.z() + 0.26));
    profile.rows.push_back(
        {name, three("%.1f, %.1f, %.1f", lost_at(0, truth.x()), lost_at(1, truth.y()), lost_at(2, truth.z())),
         two(lost_at(2, z - 0.1), lost_at(2, z + 0.1)), two(lost_at(2, z - 0.2), lost_at(2, z + 0.2)),
         too_high});
    const ExtrinsicError error = extrinsic_error(streams.T, found.T);
    const auto difference = detail::frame_a_difference(streams.T, found.T);
    char text[64];
    std::snprintf(text, sizeof text, "%.3f deg, %.1f cm", degrees * error.rotation, 100 * error.translation);
    const char* format = "%.1f, %.1f, %.1f cm";
    table.rows.push_back(
        {name, text, three(format, 100 * difference[0], 100 * difference[1], 100 * difference[2]),
         three(format, 100 * found.left_out[0], 100 * found.left_out[1], 100 * found.left_out[2]),
         three(format, 100 * found.curvature[0], 100 * found.curvature[1], 100 * found.curvature[2])});
  };
  add("lidar, at the camera's stamps", {by_camera});
  add("camera, at the lidar's stamps", {by_lidar});
  add("both problems together", {by_camera, by_lidar});
  const int errors = bench::publish(table, write, check), profiles = bench::publish(profile, write, check);
  return std::max(errors, profiles);
}
