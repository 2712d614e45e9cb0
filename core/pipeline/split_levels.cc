#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/status_macros.h"
#include "core/hierarchy/forest.h"
#include "core/hierarchy/tree_builder.h"
#include "core/pipeline/methods.h"

namespace marrow {
namespace {

// Where the work on a body stands.
struct Growing {
  double share;
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
  explicit Forest(const Job& job) : prepared_(job.prepared) {
    for (const auto& body : job.bodies)
      bodies_.push_back(
          {body->share(),
           TreeBuilder(body->context(), job.options.split, body->area())});
    Plant();
  }

  // As TreeBuilder::Deepen(); the first split of several bodies is into them.
  absl::StatusOr<bool> Deepen(const CancelToken& cancel,
                              const std::function<void(double)>& progress) {
    if (bodies_.size() > 1 && !std::exchange(apart_, true)) return true;
    bool any = false;
    double before = 0;
    for (Growing& body : bodies_) {
      MARROW_ASSIGN_OR_RETURN(
          const bool deeper, body.Deepen(cancel, [&](double share) {
            progress(std::min(1.0, before + body.share * share));
          }));
      any |= deeper;
      before += body.share;
    }
    Plant();
    return any;
  }

  void StopAtDepth() {
    for (Growing& body : bodies_) body.builder.StopAtDepth();
    Plant();
  }

  const SegmentTree& tree() const {
    return prepared_.bodies.IsWhole() ? bodies_[0].builder.tree() : tree_;
  }
  // At most once, and the last.
  SegmentTree TakeTree() {
    return prepared_.bodies.IsWhole() ? bodies_[0].builder.TakeTree()
                                      : std::move(tree_);
  }

 private:
  void Plant() {
    if (prepared_.bodies.IsWhole()) return;
    std::vector<const SegmentTree*> trees;
    for (const Growing& body : bodies_) trees.push_back(&body.builder.tree());
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
  const uint32_t levels = job.options.levels;
  Forest forest(job);
  for (uint32_t level = 1; level <= levels; ++level) {
    absl::Status reported;
    MARROW_ASSIGN_OR_RETURN(
        const bool deeper, forest.Deepen(job.cancel, [&](double share) {
          reported.Update(job.reporter.Progress(
              Stage::kSegments, kSpectrumDone + (1 - kSpectrumDone) *
                                                    (level - 1 + share) /
                                                    levels));
        }));
    MARROW_RETURN_IF_ERROR(reported);
    if (!deeper && level > 1) break;
    MARROW_RETURN_IF_ERROR(EmitLevel(job, forest.tree(), level));
    if (!deeper) break;
  }
  forest.StopAtDepth();
  return EmitTree(job,
                  std::make_shared<const SegmentedMesh>(
                      job.workspace, job.options.split, forest.TakeTree()));
}

}  // namespace marrow
