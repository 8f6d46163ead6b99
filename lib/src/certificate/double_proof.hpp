// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "certificate/proof.hpp"

// The proofs of an ordinary answer in double, in the coordinates of the answer: docs/method.md, "In double".
namespace egocal::detail {

/// Curvatures of the cost along half of the rotation (1) and half of the translation (2), as Displacement has
/// them.
struct Curvatures {
  double rotation = 0, translation = 0;
};

/// Z in the coordinates y of an answer v = (r, d): x = Ty with the columns of T (r i, d i), ..., (0, r i),
/// ..., (0, r), v. They are entries of v and their negatives, so T is exact, whatever v is.
using LocalForm = Eigen::Matrix<double, 8, 8>;

/// Proves Z - c P'P >= 0 for forms P of a displacement from v, as proven_semidefinite() of the matrices in
/// their own coordinates does, at a fraction of the cost. False proves nothing: where v is not optimal up to
/// rounding, or a direction hardly shows, only the longer mantissa decides. True is stronger than that of
/// proven_semidefinite(), see below: no proof depends on which of the two was tried first.
///
/// Let u = 2^-53, |T_i| = t_i, tau at least |Q|_F + 2 |bound| + 3 |lambda_2|, and so at least |Z|_F. In exact
/// numbers
///
///     T'ZT = [C b; b' alpha],    alpha = J(v) - bound |r|^2 + 2 lambda_2 r'd.
///
/// (1) alpha is a small difference and known from the cost, which was summed in Extended: J to u |J| (it was
///     rounded to double) and 18 u_x |Q|_F |v|^2, u_x = epsilon of Extended / 2, the rest of the formula to
///     16 u_x (|J| + |bound| + 2 |lambda_2| |r||d|). 64 u_x tau |v|^2 is more than the sum without u |J|.
/// (2) The form in double differs in each entry by at most 17 u tau t_i t_j, up to u^2: one rounding in an
///     entry of Z, eight in each of two products (Higham, section 3.5; the order of the sums does not
///     matter). With D = diag(t_i) the seven rows of C are at least those computed less 7 * 17 u tau D^2.
/// (3) [C b; b' alpha] >= 0 where C - bb' / alpha >= 0, and bb' <= |D^-1 b|^2 D^2.
/// (4) L D L' of an n x n matrix with entries m_ij, n = 7, that runs to its end with positive pivots has
///     factored one whose entries differ by at most (n + 3) u sqrt(m_ii m_jj) (Higham, theorem 10.5, and the
///     reciprocal; Rump 2006), and m_ii <= (1 + 17 u) tau t_i^2: 70 u tau D^2.
/// (5) |p_v|^2 is exactly |r|^4 |y_rotation|^2, and p_dv is |r|^2 y_translation + 2 (r'd) y_rotation, so that
///     |p_dv|^2 <= (1 + w) |r|^4 |y_translation|^2 + (1 + 1 / w) 4 (r'd)^2 |y_rotation|^2 for any w. Neither
///     has a part along v or (0, r): alpha and b stay what they are.
/// (6) That proven_semidefinite() succeeds as well: it computes Z - c P'P - margins with entries that are off
///     by parts of E = diag |Z_ii| which are together at most 212 epsilon of Extended, and succeeds where
///     64 epsilon of the diagonal are left (Higham, theorem 10.7: n (n + 2) u_x, n = 8). So it is asked that
///     Z - c P'P >= kappa E, kappa = 512 epsilon. T'ET <= 2 v'Ev on the last coordinate, plus twice the other
///     part, at most 2 * 7 tau D^2.
///
/// (2), (4) and 4 u for the matrix that is factored make 193 u, of which 256 u are given away, which covers
/// the rounding of these few numbers themselves. tau within 1e-100 and 1e100 keeps underflow below all that.
class DoubleProof {
 public:
  /// Reads only the lower triangle and the last column of the form.
  DoubleProof(const Square<8>& Q, const Column<8>& v, double cost, double bound, double orthogonal,
              const LocalForm& form);
  /// Whether this is proven: J(q') >= bound for every q' with |r'| = 1 and r'd' = 0.
  bool bound() const;
  /// Whether this is proven: J(q') - bound is at least c.rotation |p_v|^2, and at least c.translation
  /// |p_dv|^2, and not negative.
  bool curvatures(const Curvatures& c) const;

 private:
  const LocalForm& form_;
  double square_ = 0;                       ///< upper bound of |r|^4
  double orthogonal_ = 0;                   ///< upper bound of what (5) adds to the rotations, in parts of c
  double shift_real_ = 0, shift_dual_ = 0;  ///< what is given away of the diagonal
  bool usable_ = false;
};

/// The bound alone; Q exactly symmetric. cost: that of v.
bool proven_in_double(const Square<8>& Q, const Column<8>& v, double cost, double bound, double orthogonal);

}  // namespace egocal::detail
