// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The joint minimum is global: docs/rigs.md has the proof, in the notation of this file. Plain loops: the
// compiler unrolls Eigen's products of this size for minutes.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "certificate/proof.hpp"
#include "egocal/problem/cost.hpp"
#include "rig/joint.hpp"

namespace egocal::detail {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// A form x'Zx or a product of displacements in double precision is off by less than this part of the sum of
/// the absolute values of its terms: fewer than 64 roundings lie between the poses and any such number.
constexpr double form_error = 256 * epsilon;
/// Upper bounds that are made of positive terms alone are raised by this part.
constexpr double upwards = 1 + 1e-9;
/// A pair's bound is proven this far below its minimum, as a part of it: where the bound meets the minimum
/// the form is singular and rounding decides. It costs the certificate its root, a thousandth of the noise.
constexpr double bound_slack = 1e-6;
/// Part of a guessed curvature that is to be proven.
constexpr double guess_part = 0.9;

/// p' of a dual quaternion in the order w x y z of real, then of dual.
using Vector8 = std::array<double, 8>;

Vector8 to_array(const DualQuaternion& q) {
  Vector8 v;
  for (int i = 0; i < 4; ++i) {
    v[static_cast<std::size_t>(i)] = q.real[i];
    v[static_cast<std::size_t>(i) + 4] = q.dual[i];
  }
  return v;
}

double length(const Vector8& v, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += v[i] * v[i];
  return std::sqrt(sum);
}

/// x y of dual quaternions.
Vector8 product(const Vector8& x, const Vector8& y) {
  const auto add = [](const double* p, const double* q, double* r) {
    r[0] += p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
    r[1] += p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
    r[2] += p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
    r[3] += p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
  };
  Vector8 result{};
  add(x.data(), y.data(), result.data());
  add(x.data(), y.data() + 4, result.data() + 4);
  add(x.data() + 4, y.data(), result.data() + 4);
  return result;
}

/// Z(lambda) of one pair (21) at the joint minimum's m = q_a^-1 q_b: J(q') - bound = q''Z q' for unit q'.
class Form {
 public:
  Form(const JointPair& pair, const std::vector<DualQuaternion>& poses)
      : m_(to_array(relative(poses[pair.a], poses[pair.b]))),
        lever_(poses[pair.a].dual.norm() + poses[pair.b].dual.norm()) {
    lambda_ = least_squares_multipliers(pair.Q, pair.optimum);
    minimum_ = cost(pair.Q, pair.optimum);
    set(pair.Q, 0);
    const double slack = bound_slack * minimum_ + 64 * error_of(1, 0, 1, 0);
    lambda_.norm = minimum_ - slack;
    set(pair.Q, lambda_.norm);
  }

  double bound() const { return lambda_.norm; }
  double multiplier() const { return lambda_.orthogonal; }
  const Vector8& m() const { return m_; }

  /// (m x)'Z (m y).
  double at(const Vector8& x, const Vector8& y) const {
    const Vector8 mx = product(m_, x), my = product(m_, y);
    double sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      double row = 0;
      for (std::size_t k = 0; k < 8; ++k) row += Z_[i][k] * my[k];
      sum += mx[i] * row;
    }
    return sum;
  }
  /// Bounds the error of at(), from the lengths of the real and dual parts of x and y.
  double error_of(double xr, double xd, double yr, double yd) const {
    const double x = xd + lever_ * xr, y = yd + lever_ * yr;
    return form_error * (size_rr_ * xr * yr + size_rd_ * (xr * y + x * yr) + size_dd_ * x * y);
  }
  double error_of(const Vector8& x, const Vector8& y) const {
    return error_of(length(x, 0, 4), length(x, 4, 8), length(y, 0, 4), length(y, 4, 8));
  }
  /// At least (m x)'Z (m x).
  double at_most(const Vector8& x) const { return std::max(0.0, at(x, x)) + error_of(x, x); }
  /// At least the same for every x = (0, v), |v| = 1.
  double dual_at_most() const { return size_dd_ * upwards; }

 private:
  void set(const Matrix8d& Q, double bound) {
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 8; ++k) Z_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = Q(i, k);
    for (std::size_t i = 0; i < 4; ++i) {
      Z_[i][i] -= bound;
      Z_[i][i + 4] += lambda_.orthogonal;
      Z_[i + 4][i] += lambda_.orthogonal;
    }
    const auto norm = [&](std::size_t row, std::size_t column) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) sum += Z_[row + i][column + k] * Z_[row + i][column + k];
      return std::sqrt(sum);
    };
    size_rr_ = norm(0, 0);
    size_rd_ = norm(0, 4);
    size_dd_ = norm(4, 4);
  }

  Vector8 m_;
  double lever_ = 0;  ///< m is a product of poses: the rounding of its dual part is that of theirs
  Multipliers lambda_;
  double minimum_ = 0;
  std::array<std::array<double, 8>, 8> Z_{};
  double size_rr_ = 0, size_rd_ = 0, size_dd_ = 0;  ///< Frobenius norms of Z's blocks
};

constexpr Vector8 real_one = {1, 0, 0, 0, 0, 0, 0, 0}, dual_one = {0, 0, 0, 0, 1, 0, 0, 0};
constexpr std::array<std::size_t, 6> imaginary = {1, 2, 3, 5, 6, 7};

/// Coordinates y of one pose, p = p0 + eps e + C y, in which the pair with sensor 0 costs at least |y|^2 more
/// than its bound.
struct Chart {
  std::array<Vector8, 6> C;  ///< columns, imaginary dual quaternions
  double u = 0, v = 0;       ///< |real part of C y| <= u |y|, |dual part| <= v |y|
};

using Matrix6 = std::array<std::array<double, 6>, 6>;

/// H over (u, v) when p0 and e, which no displacement is free to choose, are minimised over.
Matrix6 reduced_hessian(const Form& form) {
  std::array<Vector8, 8> basis{};
  basis[0] = real_one;
  basis[1] = dual_one;
  for (std::size_t i = 0; i < 6; ++i) basis[i + 2][imaginary[i]] = 1;
  std::array<std::array<double, 8>, 8> M;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k <= i; ++k) M[i][k] = M[k][i] = form.at(basis[i], basis[k]);
  for (std::size_t out = 0; out < 2; ++out) {
    if (!(M[out][out] > 0)) continue;
    for (std::size_t i = out + 1; i < 8; ++i)
      for (std::size_t k = out + 1; k < 8; ++k) M[i][k] -= M[i][out] * M[out][k] / M[out][out];
  }
  Matrix6 H;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k) H[i][k] = M[i + 2][k + 2];
  return H;
}

/// C with C'HC = 1, upper triangular: the inverse of H's Cholesky factor. Empty where H is not positive.
std::optional<Matrix6> whitening(Matrix6 H) {
  Matrix6 L{}, inverse{}, C{};
  for (std::size_t j = 0; j < 6; ++j) {
    double pivot = H[j][j];
    for (std::size_t k = 0; k < j; ++k) pivot -= L[j][k] * L[j][k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return std::nullopt;
    L[j][j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = H[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      L[i][j] = sum / L[j][j];
    }
  }
  for (std::size_t j = 0; j < 6; ++j) {
    inverse[j][j] = 1 / L[j][j];
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum -= L[i][k] * inverse[k][j];
      inverse[i][j] = sum / L[i][i];
    }
  }
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) C[i][j] = inverse[j][i];
  return C;
}

/// Proves p'Mp >= |y|^2 for every p = p0 + eps e + C y, by the factorisation of the form in these variables.
bool proven_chart(const Form& form, const Chart& chart) {
  std::array<Vector8, 8> column{};
  column[0] = real_one;
  column[1] = dual_one;
  for (std::size_t i = 0; i < 6; ++i) column[i + 2] = chart.C[i];
  ExtendedSquare<8> N;
  std::array<double, 8> diagonal{};
  for (std::size_t i = 0; i < 8; ++i) diagonal[i] = form.at(column[i], column[i]);
  // variables of like size: the errors of a row are charged to its diagonal
  std::array<double, 8> scale;
  for (std::size_t i = 0; i < 8; ++i)
    scale[i] = i < 2 && diagonal[i] > 0 ? std::exp2(-std::round(0.5 * std::log2(diagonal[i]))) : 1;
  for (std::size_t i = 0; i < 8; ++i) {
    double error = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      N[i][k] = static_cast<Extended>(scale[i] * scale[k]) * form.at(column[i], column[k]);
      error += scale[i] * scale[k] * form.error_of(column[i], column[k]);
    }
    N[i][i] -= upwards * error + (i < 2 ? 0.0 : 1.0);
  }
  return proven_semidefinite<8>(N);
}

std::optional<Chart> chart_of(const Form& form) {
  Matrix6 H = reduced_hessian(form);
  for (auto& row : H)
    for (double& entry : row) entry *= guess_part;
  const std::optional<Matrix6> C = whitening(H);
  if (!C) return std::nullopt;
  Chart chart;
  double u = 0, v = 0;
  for (std::size_t j = 0; j < 6; ++j) {
    chart.C[j] = {};
    for (std::size_t i = 0; i < 6; ++i) chart.C[j][imaginary[i]] = (*C)[i][j];
    u += std::pow(length(chart.C[j], 0, 4), 2);
    v += std::pow(length(chart.C[j], 4, 8), 2);
  }
  chart.u = upwards * std::sqrt(u);
  chart.v = upwards * std::sqrt(v);
  if (!std::isfinite(chart.u + chart.v) || !proven_chart(form, chart)) return std::nullopt;
  return chart;
}

/// |R| of one pair is at most product |y_a| |y_b| + square_a |y_a|^2 + square_b |y_b|^2.
struct Remainder {
  double product = 0, square_a = 0, square_b = 0;
};

/// The part that the scalars p0 - 1 and e of one pose add to the remainder.
double scalar_part(const Form& form, const Chart& chart, double c) {
  const double real = std::sqrt(form.at_most(real_one)), dual = std::sqrt(form.at_most(dual_one));
  return upwards * (real * chart.u * chart.u + dual * chart.u * chart.v / c);
}

/// Least |p0| of a pose whose coordinates are at most `radius` long; 0 where it may vanish.
double least_scalar(const Chart& chart, double radius) {
  const double u = chart.u * radius;
  return u < 1 ? std::sqrt(1 - u * u) / upwards : 0;
}

/// At least the largest eigenvalue of a matrix whose entries are products of vectors: the eighth root of the
/// trace of its eighth power. `error` bounds the rounding of its trace.
double largest_eigenvalue(Matrix6 S, double error) {
  double trace = 0;
  for (std::size_t i = 0; i < 6; ++i) trace += S[i][i];
  if (!(trace > 0)) return error;
  for (auto& row : S)
    for (double& entry : row) entry /= trace;
  for (int power = 0; power < 3; ++power) {
    Matrix6 square{};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < 6; ++k) square[i][j] += S[i][k] * S[k][j];
    S = square;
  }
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += S[i][i];
  // entries are at most 1 here: their rounding is far below 1e-12, and the sum at least 6^-7
  return upwards * trace * std::pow(sum + 1e-12, 0.125) + error;
}

/// The product x y of displacements a and b, in the pair's norm, is at most this times both lengths.
double bilinear_of(const Form& form, const std::array<Vector8, 6>& a, const std::array<Vector8, 6>& b) {
  // |sum y_k x_k y|^2 <= |y|^2 b'S b with S the sum over the directions of a
  Matrix6 S{};
  double error = 0;
  for (const Vector8& x : a) {
    std::array<Vector8, 6> product_of;
    const double xr = length(x, 0, 4), xd = length(x, 4, 8);
    for (std::size_t l = 0; l < 6; ++l) {
      product_of[l] = product(x, b[l]);
      // the product may cancel: its error is that of its factors
      const double yr = length(b[l], 0, 4), yd = length(b[l], 4, 8);
      const double real = xr * yr, dual = xr * yd + xd * yr;
      error += form.error_of(real, dual, real, dual);
    }
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t l = 0; l <= k; ++l) S[k][l] = S[l][k] += form.at(product_of[k], product_of[l]);
  }
  // an error matrix of entries e_k e_l has the norm sum e_k^2
  return std::sqrt(largest_eigenvalue(S, error));
}

Remainder remainder_of(const Form& form, const Chart& a, const Chart& b, double radius) {
  const double c_a = least_scalar(a, radius), c_b = least_scalar(b, radius);
  const Vector8& m = form.m();
  const Vector8 back = {m[0], -m[1], -m[2], -m[3], m[4], -m[5], -m[6], -m[7]};
  // displacements of a as b sees them
  std::array<Vector8, 6> seen;
  double seen_curvature = 0, curvature = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    seen[k] = product(back, product(a.C[k], m));
    seen[k][0] = seen[k][4] = 0;
    seen_curvature += form.at_most(seen[k]);
    curvature += form.at_most(b.C[k]);
  }
  const double h = std::sqrt(form.dual_at_most());
  Remainder result;
  result.square_a = scalar_part(form, a, c_a);
  result.square_b = scalar_part(form, b, c_b);
  result.product = upwards * (bilinear_of(form, seen, b.C) +
                              radius * (a.u * a.u * std::sqrt(curvature) + h * a.u * a.v * b.u / c_a +
                                        b.u * b.u * std::sqrt(seen_curvature) + h * b.u * b.v * a.u / c_b));
  return result;
}

/// Adds this pair's part of the gradient over the coordinates of `chart`, and what rounding may have done.
void add_gradient(const Form& form, const std::array<Vector8, 6>& directions, double sign,
                  std::array<double, 6>& gradient, double& error) {
  for (std::size_t k = 0; k < 6; ++k) {
    gradient[k] += sign * 2 * form.at(real_one, directions[k]);
    error += 2 * form.error_of(real_one, directions[k]);
  }
}

struct Charts {
  std::vector<std::optional<Chart>> of;  ///< empty for sensor 0
};

std::optional<Charts> charts_of(std::span<const JointPair> pairs, const std::vector<Form>& forms,
                                std::size_t sensors) {
  Charts charts{std::vector<std::optional<Chart>>(sensors)};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].a != 0 || charts.of[pairs[i].b]) continue;
    charts.of[pairs[i].b] = chart_of(forms[i]);
    if (!charts.of[pairs[i].b]) return std::nullopt;
  }
  for (std::size_t s = 1; s < sensors; ++s)
    if (!charts.of[s]) return std::nullopt;
  return charts;
}

/// |R| <= kappa |Y|^2 for all pairs together.
double curvature_of(std::span<const JointPair> pairs, const std::vector<Form>& forms, const Charts& charts,
                    double radius) {
  std::vector<double> squares(charts.of.size(), 0);
  double product = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Chart& b = *charts.of[pairs[i].b];
    if (pairs[i].a == 0) {
      squares[pairs[i].b] += std::pow(scalar_part(forms[i], b, least_scalar(b, radius)), 2);
      continue;
    }
    const Remainder part = remainder_of(forms[i], *charts.of[pairs[i].a], b, radius);
    squares[pairs[i].a] += part.square_a * part.square_a;
    squares[pairs[i].b] += part.square_b * part.square_b;
    product = std::max(product, part.product);
  }
  return upwards *
         (std::sqrt(0.5) * product + std::sqrt(2 * *std::max_element(squares.begin(), squares.end())));
}

/// The length of the gradient over all coordinates, at most.
double gradient_length(std::span<const JointPair> pairs, const std::vector<Form>& forms,
                       const Charts& charts) {
  std::vector<std::array<double, 6>> gradient(charts.of.size(), std::array<double, 6>{});
  double error = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    add_gradient(forms[i], charts.of[pairs[i].b]->C, 1, gradient[pairs[i].b], error);
    if (pairs[i].a == 0) continue;
    const Vector8& m = forms[i].m();
    const Vector8 back = {m[0], -m[1], -m[2], -m[3], m[4], -m[5], -m[6], -m[7]};
    std::array<Vector8, 6> seen;
    for (std::size_t k = 0; k < 6; ++k) seen[k] = product(back, product(charts.of[pairs[i].a]->C[k], m));
    add_gradient(forms[i], seen, -1, gradient[pairs[i].a], error);
  }
  double sum = 0;
  for (const auto& part : gradient)
    for (const double g : part) sum += g * g;
  return upwards * (std::sqrt(sum) + error);
}

}  // namespace

std::optional<JointProof> prove_joint_minimum(std::span<const JointPair> pairs,
                                              const std::vector<DualQuaternion>& poses) {
  JointProof proof;
  std::vector<Form> forms;
  double gap = 0, cost = 0;
  for (const JointPair& pair : pairs) {
    const Form& form = forms.emplace_back(pair, poses);
    if (!proven_bound<8>(pair.Q, form.bound(), form.multiplier(), 0)) return std::nullopt;
    const double excess = form.at_most(real_one);
    gap += excess;
    cost += form.bound() + excess;
    proof.pairwise_bound += form.bound();
    proof.rounding += 2 * form.error_of(real_one, real_one);
  }
  // sums of so few terms that their rounding is far below the margins in them
  gap *= upwards;
  proof.lower_bound = proof.pairwise_bound -= form_error * std::abs(proof.pairwise_bound);
  const double radius = std::sqrt(gap) * upwards;
  const std::optional<Charts> charts = charts_of(pairs, forms, poses.size());
  if (!charts) return proof;
  for (std::size_t s = 1; s < poses.size(); ++s)
    if (!(least_scalar(*charts->of[s], radius) > 0)) return proof;
  const double eta = curvature_of(pairs, forms, *charts, radius) * radius * upwards;
  const double convexity = (1 - eta) * (1 - eta) - 2 * eta * upwards;
  if (!(eta < 1) || !(convexity > 0)) return proof;
  const double gradient = gradient_length(pairs, forms, *charts);
  proof.global = true;
  // `cost` is at most its rounding above that of the poses; the rest is the least value of
  // convexity |X|^2 - |gradient| |X|
  const double bound = cost - proof.rounding - upwards * gradient * gradient / (4 * convexity);
  proof.lower_bound = std::max(proof.lower_bound, bound);
  return proof;
}

}  // namespace egocal::detail
