// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstring>

int main(int count, char** arguments) {
  char name[16];  // what the stack protector and _FORTIFY_SOURCE watch
  std::strcpy(name, arguments[count - 1]);
  return std::puts(name) < 0 ? 1 : 0;
}
