// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/layout.hpp"

#include "egocal/online/algorithm1.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/rig/rig.hpp"
#include "egocal/samples/calibrate_samples.hpp"

#define EGOCAL_DEFINE_LAYOUT(Type) \
  template <>                      \
  const char Layout<Type, sizeof(Type), alignof(Type)>::same_as_in_the_library = 0;

namespace egocal::detail {

EGOCAL_DEFINE_LAYOUT(Pose)
EGOCAL_DEFINE_LAYOUT(DualQuaternion)
EGOCAL_DEFINE_LAYOUT(Multipliers)
EGOCAL_DEFINE_LAYOUT(MotionPair)
EGOCAL_DEFINE_LAYOUT(Balance)
EGOCAL_DEFINE_LAYOUT(Statistics)
EGOCAL_DEFINE_LAYOUT(GroundPlane)
EGOCAL_DEFINE_LAYOUT(Problem)
EGOCAL_DEFINE_LAYOUT(CertificateOptions)
EGOCAL_DEFINE_LAYOUT(Certificate)
EGOCAL_DEFINE_LAYOUT(Solution)
EGOCAL_DEFINE_LAYOUT(Observability)
EGOCAL_DEFINE_LAYOUT(Answer)
EGOCAL_DEFINE_LAYOUT(OnlineOptions)
EGOCAL_DEFINE_LAYOUT(OnlineState)
EGOCAL_DEFINE_LAYOUT(OnlineStep)
EGOCAL_DEFINE_LAYOUT(StampedPose)
EGOCAL_DEFINE_LAYOUT(RigEdge)
EGOCAL_DEFINE_LAYOUT(PoseSample)

}  // namespace egocal::detail
