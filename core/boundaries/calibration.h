// The calibrated constants of METHOD_MERGE, all of them: ten weights, a
// few thresholds, and how pieces are made.
//
// The weights are a logistic regression on human segmentations of articulated
// bodies: does merging two groups disagree with more people than it agrees
// with? Its samples are the boundaries met on the best way of merging each
// body's pieces, and on the way that the weights before took, each weighted by
// the square root of what the wrong choice would cost. Every body takes part
// thrice: as it is, with noise of half the mean edge, and with a third of its
// faces, so that no weight rests on what either would take away. The measures
// are standardised for the fit, with a ridge of 0.005 of the samples' weight on
// each slope, so that a measure which hardly helps hardly counts. Measures
// whose weight would have the wrong sign, or none to speak of, were left out:
// on other poses, and on rough meshes, they did harm.
#ifndef MARROW_CORE_BOUNDARIES_CALIBRATION_H_
#define MARROW_CORE_BOUNDARIES_CALIBRATION_H_

#include <cstdint>

#include "core/boundaries/boundary_meter.h"

namespace marrow {

// By Measure. Positive: more of it speaks for keeping the boundary. A short cut
// off large groups is kept (lengths and areas), most of all where it is one
// loop along which the surface is a saddle, and beside which it widens.
inline constexpr Measures kStrengthWeights = {
    -9.638,  // kConstant
    -0.834,  // kLength
    -1.346,  // kRelativeLength
    1.295,   // kLargerArea
    3.963,   // kSaddleNear
    4.433,   // kSaddleMiddle
    2.446,   // kSaddleWide
    1.545,   // kStripOfSmaller
    1.181,   // kStripOfLarger
    6.181,   // kLargestLoop
};

// Of the area: a closed shell of so much beside another is as likely a part as
// not. It is one of the automatic cut from .012 on, and of level 1 from .032.
// Not fitted: people were not asked about shells.
inline constexpr double kShellShare = 0.0087;

// Of the area: so small a group is not a part, whatever its boundary. It takes
// nothing to speak of from a finger, which has ten times as much.
inline constexpr double kSpeckShare = 2e-4;

// Levels are the cuts of the merged pieces at these saliences, the same for
// every mesh. The second is the automatic cut: boundaries that are kept more
// likely than 2 to 1. From 0.6 to 0.7 the Rand index of unseen categories moves
// by .001 only. Above, cuts change more with noise and triangles; below, with
// poses.
inline constexpr double kLevelSalience[] = {0.93, 0.65, 0.3};
inline constexpr double kAutomaticSalience = kLevelSalience[1];

// Beyond the automatic cut, in log odds, a boundary counts more between groups
// that the first split of the pieces' tree has parted than between those of one
// of its segments: a bent knee may be as strong as the hip, but the leg is
// split off first. Which boundaries are in the automatic cut is not changed by
// it. On the benchmark the Rand index of level 1 falls from .098 to .087,
// between poses from .089 to .049. Within a segment, gains of .65, .58 and .5
// give .084, .086 and .091 on the benchmark; the less, the sooner a muzzle
// joins its head, which people want of a first level. Of parted ones
// 4 to 8 do about the same, but a head whose neck the arms interrupt needs 8.
// The lead is more than it takes to be in level 1, and keeps strong boundaries
// apart in what a double can hold. As moved boundaries are not quite where the
// split had them, groups are of one segment up to kTogether and parted from
// kApart on, by PieceGraph::ApartInFirstSplit().
inline constexpr double kTogether = 0.25;
inline constexpr double kApart = 0.75;
inline constexpr double kLaterSplitGain = 0.55;
inline constexpr double kFirstSplitGain = 8;
inline constexpr double kFirstSplitLead = 2;

// Pieces are the leaves of the paper's tree of this depth at this kappa.
// Deeper trees have more wrong boundaries to choose from and hardly more right
// ones. But in a leaf of more than kLargePiece of the area there may be more,
// as thirty legs are in the thirds of a centipede's trunk: such are split on,
// to kMostPieceLevels at most, if that gives at least kFewestOfLarge parts: two
// or three are the middle of a palm and its rim. On the benchmark that is no
// matter; from half as much of the area on it does harm to noisy bodies.
inline constexpr uint32_t kPieceLevels = 2;
inline constexpr uint32_t kMostPieceLevels = 4;
inline constexpr double kLargePiece = 0.1;
inline constexpr size_t kFewestOfLarge = 4;
inline constexpr double kPieceKappa = 1;

// Across boundaries of less salience pieces merge before the others are moved
// once more: where a boundary ends up depends on the pieces beside it, and many
// of the small ones are a matter of chance. It lets noise, triangles and poses
// change a tenth less of the cut. From 0.15 to 0.2 is about the same.
inline constexpr double kChanceSalience = 0.15;

// How boundaries are moved: see core/boundaries/boundary_mover.h. Without the
// discount the Rand index of the best merging is worse by a fifth; once it is
// there, a third more or less of any of these changes little.
inline constexpr int kMovePasses = 2;
inline constexpr double kBandWidth = 4;        // of pieces
inline constexpr double kMergedBandWidth = 6;  // the second time
inline constexpr double kBandShare = 0.4;
inline constexpr double kCreaseWidth = 0.5;
inline constexpr double kCreaseCurvature = 0.3;
inline constexpr double kCreaseDiscount = 0.8;

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_CALIBRATION_H_
