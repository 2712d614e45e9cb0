// The calibrated constants of METHOD_MERGE, all of them: thirteen weights and
// three thresholds.
//
// The weights are a logistic regression on human segmentations of articulated
// bodies: does merging two groups disagree with more people than it agrees
// with? Its samples are the boundaries met on the best way of merging each
// body's pieces, and on the way that the weights before took, each weighted by
// the square root of what the wrong choice would cost. The measures are
// standardised for the fit, with a ridge of 0.005 of the samples' weight on
// each slope, so that a measure which hardly helps hardly counts.
#ifndef MARROW_CORE_BOUNDARIES_CALIBRATION_H_
#define MARROW_CORE_BOUNDARIES_CALIBRATION_H_

#include <cstdint>

#include "core/boundaries/boundary_meter.h"

namespace marrow {

// By Measure. Positive: more of it speaks for keeping the boundary. A short cut
// off large groups is kept (lengths and areas), most of all where the surface
// is a saddle all along it and widens beside it.
inline constexpr Measures kStrengthWeights = {
    0.296,   // kConstant
    -0.934,  // kLength
    -1.217,  // kRelativeLength
    0.151,   // kSmallerArea
    1.080,   // kLargerArea
    -1.258,  // kCurvatureNear
    3.235,   // kSaddleNear
    3.161,   // kCurvatureWide
    2.915,   // kSaddleWide
    0.079,   // kNearStripOfSmaller
    0.707,   // kNearStripOfLarger
    1.061,   // kWideStripOfSmaller
    0.489,   // kWideStripOfLarger
};

// Levels are the cuts of the merged pieces at these saliences, the same for
// every mesh. The second is the automatic cut: boundaries that are kept more
// likely than 7 to 3, a compromise of the Rand index (least at 0.6) and of the
// Hamming distance (least at 0.8).
inline constexpr double kLevelSalience[] = {0.93, 0.7, 0.3};

// Pieces are the leaves of the paper's tree of this depth at this kappa.
// Deeper trees have more wrong boundaries to choose from and hardly more right
// ones.
inline constexpr uint32_t kPieceLevels = 2;
inline constexpr double kPieceKappa = 1;

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_CALIBRATION_H_
