// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "egocal/diagnosis/diagnose.hpp"

namespace egocal {

namespace detail {
struct Foreseen;
}

/// What diagnose() looks at before it needs the answer, most of its time: it can be done while the poses are
/// paired. The trajectories must still be there when it is used.
class Foresight {
 public:
  /// pairing: as for the answer, with the time offset in force.
  Foresight(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
            const DiagnosisOptions& options);
  ~Foresight();
  Foresight(const Foresight&) = delete;
  Foresight& operator=(const Foresight&) = delete;

  /// The same bits as the diagnose() that begins with the answer.
  Diagnosis diagnose(const Answered& answered) const;

 private:
  std::unique_ptr<detail::Foreseen> foreseen_;
};

}  // namespace egocal
