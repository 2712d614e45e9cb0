#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/fine_tree.h"
#include "core/hierarchy/forest.h"
#include "core/hierarchy/tree_builder.h"
#include "core/pipeline/methods.h"

namespace marrow {
namespace {

// What its pairs are of a level.
constexpr double kPairsShare = 0.5;

// Where the work on a body stands.
struct Growing {
  PreparedBody* body;
  TreeBuilder builder;
  bool done = false;

  // Whether it became deeper. Not tried again once it did not.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress) {
    if (done) return false;
    MARROW_ASSIGN_OR_RETURN(const bool deeper,
                            builder.Deepen(cancel, progress));
    done = !deeper;
    return deeper;
  }
};

// The tree of the whole mesh, a level at a time.
class Forest {
 public:
  // REQUIRES: the bodies have the pairs that a region of all of them takes.
  explicit Forest(const Job& job) : prepared_(job.prepared) {
    for (const auto& body : job.bodies)
      bodies_.push_back(
          {body.get(),
           TreeBuilder(body->context(), job.options.split, body->area())});
    Plant();
  }

  // The pairs that the next level takes.
  absl::Status Pull(const Job& job, const ProgressCallback& progress) {
    double before = 0;
    for (Growing& growing : bodies_) {
      const double share = growing.body->share();
      if (!growing.done) {
        MARROW_RETURN_IF_ERROR(growing.body->Pull(
            growing.builder.LeastShare(), job.options.split.delta, job.cancel,
            [&](double done) {
              progress(std::min(1.0, before + share * done));
            }));
      }
      before += share;
    }
    return absl::OkStatus();
  }

  // As TreeBuilder::Deepen(); the first split of several bodies is into them.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress) {
    if (bodies_.size() > 1 && !std::exchange(apart_, true)) return true;
    bool any = false;
    double before = 0;
    for (Growing& growing : bodies_) {
      const double area = growing.body->share();
      MARROW_ASSIGN_OR_RETURN(const bool deeper,
                              growing.Deepen(cancel, [&](double share) {
                                progress(std::min(1.0, before + area * share));
                              }));
      any |= deeper;
      before += area;
    }
    Plant();
    return any;
  }

  void StopAtDepth() {
    for (Growing& body : bodies_) body.builder.StopAtDepth();
    Plant();
  }

  const SegmentTree& tree() const {
    return prepared_.bodies.IsComputedWhole() ? bodies_[0].builder.tree()
                                              : tree_;
  }
  // At most once, and the last.
  SegmentTree TakeTree() {
    return prepared_.bodies.IsComputedWhole() ? bodies_[0].builder.TakeTree()
                                              : std::move(tree_);
  }

 private:
  void Plant() {
    if (prepared_.bodies.IsComputedWhole()) return;
    std::deque<SegmentTree> fine;
    std::vector<const SegmentTree*> trees;
    for (size_t b = 0; b < bodies_.size(); ++b) {
      const SegmentTree& tree = bodies_[b].builder.tree();
      const Body& body = prepared_.bodies.bodies[b];
      trees.push_back(&tree);
      if (body.coarse != nullptr)
        trees.back() = &fine.emplace_back(
            ToFine(*trees.back(), *body.coarse, body.Patched().mesh));
      if (body.patched != nullptr)
        trees.back() =
            &fine.emplace_back(WithoutPatches(*trees.back(), body.patched->mesh,
                                              body.canonical->mesh.NumFaces()));
    }
    tree_ = PlantForest(prepared_.canonical, prepared_.areas, prepared_.bodies,
                        trees, BodyRoots::kLevelOne);
  }

  const Prepared& prepared_;
  std::vector<Growing> bodies_;
  bool apart_ = false;
  SegmentTree tree_;
};

}  // namespace

absl::Status SplitLevels(const Job& job) {
  MARROW_RETURN_IF_ERROR(PullPairs(job));
  Forest forest(job);
  for (uint32_t level = 1; level <= job.options.levels; ++level) {
    absl::Status reported;
    const auto report = [&](double share) {
      reported.Update(job.reporter.Progress(
          Stage::kSegments, kSpectrumDone + (1 - kSpectrumDone) *
                                                (level - 1 + share) /
                                                job.options.levels));
    };
    MARROW_RETURN_IF_ERROR(
        forest.Pull(job, [&](double share) { report(kPairsShare * share); }));
    MARROW_ASSIGN_OR_RETURN(const bool deeper,
                            forest.Deepen(job.cancel, [&](double share) {
                              report(kPairsShare + (1 - kPairsShare) * share);
                            }));
    MARROW_RETURN_IF_ERROR(reported);
    if (!deeper && level > 1) break;
    MARROW_RETURN_IF_ERROR(EmitLevel(job.telling(), forest.tree(), level));
    if (!deeper) break;
  }
  forest.StopAtDepth();
  return EmitTree(job.telling(),
                  std::make_shared<const SegmentedMesh>(
                      job.workspace, job.options.split, forest.TakeTree()));
}

}  // namespace marrow
