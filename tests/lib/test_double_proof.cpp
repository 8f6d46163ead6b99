// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What is proven in double must be true, and proven by the longer way as well, however near to singular the
// matrices are and whatever the multipliers.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "../support/random_motion.hpp"
#include "certificate/assess.hpp"
#include "egocal/solvers/global.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "problem/tangent.hpp"

namespace egocal::test_double_proof {
namespace {

using detail::Curvatures;
using detail::DoubleProof;
using detail::LocalForm;
using testing::Motion;
using testing::Random;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;  // 113 bits of mantissa
#else
typedef long double Quad;
#endif

/// Without one nothing is proven in double, for the margins are parts of its last place.
bool longer_mantissa() {
  return detail::extended_epsilon() <= epsilon / 1024;
}

struct Proposal {
  Matrix8d Q;
  DualQuaternion q;
  double cost = 0, bound = 0, orthogonal = 0;
  detail::Column<8> v() const { return q.vec(); }
};

LocalForm local_form(const Proposal& p) {
  LocalForm Z = p.Q, T;
  T << detail::tangent_basis(p.q), Vector8d::Zero(), p.q.vec();
  T.col(6).tail<4>() = p.q.real;
  for (int i = 0; i < 4; ++i) {
    Z(i, i) -= p.bound;
    Z(i, i + 4) += p.orthogonal;
    Z(i + 4, i) += p.orthogonal;
  }
  return T.transpose() * Z * T;
}

/// Z - c P'P is positive definite, in 113 bits; those of the products are exact.
template <std::size_t Rows>
bool truly_definite(const Proposal& p, double c, const detail::Forms<8, Rows>& P) {
  Quad M[8][8];
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      M[i][j] = p.Q(i, j);
      if (i == j && i < 4) M[i][j] -= p.bound;
      if (std::abs(i - j) == 4) M[i][j] += p.orthogonal;
      for (const auto& row : P)
        M[i][j] -= Quad(c) * Quad(row[static_cast<std::size_t>(i)]) * Quad(row[static_cast<std::size_t>(j)]);
    }
  for (int j = 7; j >= 0;
       --j) {  // from the rotation of the competitor to its translation is worse conditioned
    if (!(M[j][j] > 0)) return false;
    for (int i = 0; i < j; ++i) {
      const Quad factor = M[i][j] / M[j][j];
      for (int k = 0; k < j; ++k) M[i][k] -= factor * M[j][k];
    }
  }
  return true;
}

struct Counts {
  int proven = 0, only_longer = 0, refused = 0;
};

/// A bound, and curvatures at the guess of them (of which the first part is tried).
void check(const Proposal& p, const Curvatures& guess, Counts& bounds, Counts& curvatures) {
  const LocalForm form = local_form(p);
  const DoubleProof proof(p.Q, p.v(), p.cost, p.bound, p.orthogonal, form);
  const bool longer = detail::proven_bound<8>(p.Q, p.bound, p.orthogonal, 0);
  if (proof.bound()) {
    ASSERT_TRUE(longer);
    ASSERT_TRUE(truly_definite(p, 0, detail::Forms<8, 1>{}));
    ++bounds.proven;
  } else {
    ++(longer ? bounds.only_longer : bounds.refused);
  }
  if (detail::proven_in_double(p.Q, p.v(), p.cost, p.bound, p.orthogonal)) {
    ASSERT_TRUE(longer);
    ASSERT_TRUE(truly_definite(p, 0, detail::Forms<8, 1>{}));
  }
  const double part = detail::parts_of_guess[0];
  const Curvatures c{part * guess.rotation, part * guess.translation};
  const auto found = detail::proven_curvatures<8>(p.Q, p.v(), p.bound, p.orthogonal, 0, guess);
  const bool both = found.rotation == c.rotation && found.translation == c.translation;
  if (proof.curvatures(c)) {
    ASSERT_TRUE(longer);
    ASSERT_TRUE(both);
    const detail::Displacement<8> P = detail::displacement_from(p.v());
    ASSERT_TRUE(truly_definite(p, c.rotation, P.rotation));
    ASSERT_TRUE(truly_definite(p, c.translation, P.translation));
    ++curvatures.proven;
  } else {
    ++(both ? curvatures.only_longer : curvatures.refused);
  }
}

/// A number of units in the last place around nothing: 1 to 1000 of them, of either sign.
double some_units(Random& random) {
  const double units = random.log_uniform(1, 1000);
  return (random.below(2) == 0 ? -units : units) * epsilon;
}

/// As many as decide, and as many as proofs in double give away.
double few_or_many_units(Random& random) {
  return some_units(random) * (random.below(2) == 0 ? 1 : random.log_uniform(1, 1e4));
}

Proposal drive(Random& random, std::uint64_t seed) {
  Proposal p;
  const DualQuaternion T = testing::random_extrinsic(random, seed % 5 == 0 ? random.log_uniform(1, 300) : 2);
  const auto motion = seed % 4 == 3 ? Motion::single_axis : static_cast<Motion>(seed % 2);
  const Matrix8d Q = testing::cost_of(
      testing::random_pairs(
          T, {.motion = motion, .pairs = 3 + random.below(60), .noise = random.log_uniform(1e-9, 0.3)},
          random),
      {});
  const double length = detail::length_scale(Q);
  p.Q = detail::in_units_of(length, Q);
  const Solution best = solve_dual(p.Q);
  p.q = best.q;
  p.orthogonal = best.lambda.orthogonal;
  return p;
}

/// The bound of an answer, as it is proposed, or nearer to its cost, or above it.
void propose(Proposal& p, double units) {
  const double rounding = detail::rounding_of<8>(detail::sizes_of<8>(p.Q), p.v());
  p.cost = detail::extended_cost<8>(p.Q, p.v());
  p.bound = p.cost - units / 16 * rounding / epsilon;
}

/// The least curvature in some of the coordinates when the others follow, in double.
double least_curvature(const LocalForm& form, int first) {
  const Eigen::Matrix<double, 7, 7> C = form.topLeftCorner<7, 7>();
  const double inverse = detail::symmetric_eigen<3>(C.inverse().block<3, 3>(first, first)).values[2];
  return inverse > 0 ? 1 / inverse : 0;
}

Curvatures guess_near_the_truth(const Proposal& p, Random& random) {
  const LocalForm form = local_form(p);
  const double part = detail::parts_of_guess[0];
  const auto near = [&](double curvature) {
    if (random.below(2) == 0) return curvature * random.log_uniform(0.1, 1);
    return curvature / part * (1 + few_or_many_units(random));
  };
  const double rotation = near(least_curvature(form, 0)), translation = near(least_curvature(form, 3));
  return {rotation, translation};
}

void check_many(std::uint64_t first, std::uint64_t last) {
  Counts bounds, curvatures;
  for (std::uint64_t seed = first; seed < last; ++seed) {
    Random random(seed);
    Proposal p = drive(random, seed);
    switch (seed % 8) {
      case 0:  // ordinary
        propose(p, 4 * epsilon);
        break;
      case 1:  // around the largest bound that is true
        propose(p, some_units(random) * random.log_uniform(1e-3, 1));
        break;
      case 2:  // another multiplier
        p.orthogonal += random.normal() * random.log_uniform(1e-17, 1) * p.Q.norm();
        propose(p, std::abs(some_units(random)));
        break;
      case 3:  // an answer that is off
        p.q = p.q * testing::random_displacement(random, random.log_uniform(1e-17, 1e-3),
                                                 random.log_uniform(1e-17, 1e-3));
        p.q.dual += random.normal() * random.log_uniform(1e-17, 1e-3) * p.q.real;  // and not quite a unit one
        propose(p, std::abs(some_units(random)));
        break;
      case 4: {  // D singular to some units in the last place
        const auto D = detail::symmetric_eigen<4>(p.Q.bottomRightCorner<4, 4>());
        const Eigen::Vector4d u = D.vectors.col(0);
        const Eigen::Matrix4d less =
            (D.values[0] + few_or_many_units(random) * D.values[3]) * u * u.transpose();
        p.Q.bottomRightCorner<4, 4>() -= 0.5 * (less + less.transpose());
        propose(p, std::abs(some_units(random)));
        break;
      }
      case 5:    // Z singular to some units in the last place, beside the answer,
      case 6: {  // or with a bound far below, so that rounding is all that decides
        const bool far = seed % 8 == 6;
        propose(p, (far ? random.log_uniform(1e3, 1e15) : 4) * epsilon);
        const double below = p.cost - p.bound;
        LocalForm Z = p.Q;
        for (int i = 0; i < 4; ++i) {
          Z(i, i) -= p.bound;
          Z(i, i + 4) += p.orthogonal;
          Z(i + 4, i) += p.orthogonal;
        }
        const auto eigen = detail::symmetric_eigen<8>(Z);
        const int least = far ? 0 : 1;  // the first one is that of the answer
        const Vector8d u = eigen.vectors.col(least);
        const double units = far ? 0.02 * some_units(random) : few_or_many_units(random);
        const Matrix8d less = (eigen.values[least] + units * eigen.values[7]) * u * u.transpose();
        p.Q -= 0.5 * (less + less.transpose());
        propose(p, std::abs(some_units(random)));
        if (far) p.bound = p.cost - below;
        break;
      }
      default: {  // no cost matrix at all, of any size
        const Matrix8d R =
            Matrix8d::NullaryExpr([&] { return random.normal() * random.log_uniform(1e-9, 1); });
        const Matrix8d Q = R + R.transpose();
        p.Q = (p.Q + random.log_uniform(1e-18, 1e-12) * Q).eval();
        const double size = random.log_uniform(1e-110, 1e110);
        p.Q *= size;
        p.orthogonal = size * p.orthogonal + random.normal() * random.log_uniform(1e-20, 1) * p.Q.norm();
        propose(p, some_units(random));
      }
    }
    p.Q = (0.5 * (p.Q + p.Q.transpose())).eval();
    p.cost = detail::extended_cost<8>(p.Q, p.v());
    check(p, guess_near_the_truth(p, random), bounds, curvatures);
    if (::testing::Test::HasFatalFailure()) FAIL() << seed;
  }
  std::printf("bounds: %d, only longer %d, none %d; curvatures: %d, only longer %d, none %d\n", bounds.proven,
              bounds.only_longer, bounds.refused, curvatures.proven, curvatures.only_longer,
              curvatures.refused);
  if (!longer_mantissa()) {
    EXPECT_EQ(bounds.proven + curvatures.proven, 0);
    return;
  }
  const auto all = static_cast<int>(last - first);
  EXPECT_GT(bounds.proven, all / 5);
  EXPECT_GT(bounds.refused, all / 5);
  EXPECT_GT(curvatures.proven, all / 20);
}

TEST(DoubleProof, ProvesNothingThatIsNotTrueAndProvenOtherwise) {
  check_many(0, 20000);
}

TEST(DoubleProof, OrdinaryAnswersNeedNoLongerMantissa) {
  int proven = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::random_extrinsic(random);
    Proposal p;
    const Matrix8d Q = testing::cost_of(
        testing::random_pairs(T, {.motion = static_cast<Motion>(seed % 2), .noise = 0.01}, random), {});
    p.Q = detail::in_units_of(detail::length_scale(Q), Q);
    const Solution best = solve_dual(p.Q);
    p.q = best.q;
    p.orthogonal = best.lambda.orthogonal;
    propose(p, 4 * epsilon);
    if (detail::proven_in_double(p.Q, p.v(), p.cost, p.bound, p.orthogonal)) ++proven;
  }
  EXPECT_EQ(proven, longer_mantissa() ? 500 : 0);
}

}  // namespace
}  // namespace egocal::test_double_proof
