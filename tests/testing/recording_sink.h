// A sink that keeps everything it is given.
#ifndef MARROW_TESTS_TESTING_RECORDING_SINK_H_
#define MARROW_TESTS_TESTING_RECORDING_SINK_H_

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/pipeline/pipeline.h"

namespace marrow {

class RecordingSink : public Sink {
 public:
  struct Level {
    uint32_t level = 0;
    SegmentTree tree;
    std::vector<uint32_t> face_labels;
    std::vector<uint32_t> point_labels;
    Skeleton skeleton;
  };

  // Answers false to the first event that begins with `refused`: "progress",
  // "mesh", "level 1", "tree".
  explicit RecordingSink(std::string refused = "none")
      : refused_(std::move(refused)) {}

  bool OnProgress(Stage stage, double fraction) override {
    stages.push_back(stage);
    fractions.push_back(fraction);
    return Answer("progress");
  }
  bool OnMesh(const CanonicalMesh& canonical) override {
    mesh = canonical;
    events.push_back("mesh");
    return Answer("mesh");
  }
  bool OnLevel(const LevelResult& level) override {
    levels.push_back({level.level, level.tree, level.face_labels,
                      level.point_labels, level.skeleton});
    events.push_back("level " + std::to_string(level.level));
    return Answer(events.back());
  }
  bool OnTree(const SegmentTree& whole) override {
    tree = whole;
    events.push_back("tree");
    return Answer("tree");
  }
  bool OnSegmentedMesh(
      std::shared_ptr<const SegmentedMesh> whole_mesh) override {
    segmented = std::move(whole_mesh);
    return Answer("segmented mesh");
  }

  std::vector<std::string> events;  // without progress
  std::vector<Stage> stages;
  std::vector<double> fractions;
  CanonicalMesh mesh;
  std::vector<Level> levels;
  SegmentTree tree;
  std::shared_ptr<const SegmentedMesh> segmented;
  uint32_t calls_after_refusal = 0;

 private:
  bool Answer(const std::string& event) {
    if (has_refused_) ++calls_after_refusal;
    if (event == refused_) has_refused_ = true;
    return !has_refused_;
  }

  std::string refused_;
  bool has_refused_ = false;
};

}  // namespace marrow

#endif  // MARROW_TESTS_TESTING_RECORDING_SINK_H_
