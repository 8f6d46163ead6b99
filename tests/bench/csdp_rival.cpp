// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "csdp_rival.hpp"

#include <cstddef>
#include <cstdlib>
#include <initializer_list>

extern "C" {
#include <csdp/declarations.h>
}

namespace egocal::bench {

namespace {

/// CSDP counts from one and frees what it is given by free().
template <typename T>
T* allocated(std::size_t count) {
  return static_cast<T*>(std::calloc(count + 1, sizeof(T)));
}

struct Entry {
  int row, column;
  double value;
};

sparseblock* sparse(int constraint, std::initializer_list<Entry> entries) {
  auto* block = allocated<sparseblock>(0);
  block->blocknum = 1;
  block->blocksize = 8;
  block->constraintnum = constraint;
  block->numentries = static_cast<int>(entries.size());
  block->issparse = 1;
  block->entries = allocated<double>(entries.size());
  block->iindices = allocated<int>(entries.size());
  block->jindices = allocated<int>(entries.size());
  int k = 0;
  for (const Entry& entry : entries) {
    ++k;
    block->entries[k] = entry.value;
    block->iindices[k] = entry.row;
    block->jindices[k] = entry.column;
  }
  return block;
}

}  // namespace

Multipliers csdp(const Matrix8d& Q) {
  // min a . y subject to A1 y1 + A2 y2 - C >= 0, with y = lambda
  blockmatrix C{1, allocated<blockrec>(1)};
  C.blocks[1].blockcategory = MATRIX;
  C.blocks[1].blocksize = 8;
  C.blocks[1].data.mat = allocated<double>(63);
  Eigen::Map<Matrix8d>(C.blocks[1].data.mat) = -Q;
  auto* a = allocated<double>(2);
  a[1] = -1;
  auto* constraints = allocated<constraintmatrix>(2);
  constraints[1].blocks = sparse(1, {{1, 1, -1}, {2, 2, -1}, {3, 3, -1}, {4, 4, -1}});
  constraints[2].blocks = sparse(2, {{1, 5, 1}, {2, 6, 1}, {3, 7, 1}, {4, 8, 1}});

  blockmatrix X{}, Z{};
  double *y = nullptr, primal = 0, dual = 0;
  initsoln(8, 2, C, a, constraints, &X, &y, &Z);
  easy_sdp(8, 2, C, a, constraints, 0.0, &X, &y, &Z, &primal, &dual);
  const Multipliers lambda{y[1], y[2]};
  free_prob(8, 2, C, a, constraints, X, y, Z);
  return lambda;
}

}  // namespace egocal::bench
