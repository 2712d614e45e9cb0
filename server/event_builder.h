// core's results -> the messages of the contract.
#ifndef MARROW_SERVER_EVENT_BUILDER_H_
#define MARROW_SERVER_EVENT_BUILDER_H_

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "core/hierarchy/segment_tree.h"
#include "core/mesh/canonical_mesh.h"
#include "core/pipeline/pipeline.h"
#include "core/pipeline/segmented_mesh.h"
#include "core/skeleton/skeleton.h"
#include "core/spectrum/certified_spectrum.h"
#include "marrow/v1/mesh.pb.h"
#include "marrow/v1/segmentation_service.pb.h"
#include "marrow/v1/spectrum_service.pb.h"
#include "server/mesh_store.h"
#include "server/spectrum_cache.h"

namespace marrow {

// Most bytes of results in one message.
inline constexpr size_t kChunkBytes = 256 << 10;

void SetMeshDigest(const MeshDigest& digest, v1::MeshDigest* message);
void SetGeometryDigest(const Digest& digest, v1::GeometryDigest* message);
// All but the prediction, which is for a number of eigen-pairs.
void SetMeshReport(const MeshReport& report, v1::MeshReport* message);
void SetPrediction(const MeshReport& report, uint32_t eigen_pairs,
                   v1::MeshReport* message);
void SetSpectrumUse(const SpectrumUse& use, v1::SpectrumUse* message);
v1::Stage ToStage(Stage stage);

// Turns the levels of one mesh into events. A level that is not asked for
// hands its nodes and splits on to the next one, so that every parent stands
// before its children. Not thread safe.
class LevelEvents {
 public:
  explicit LevelEvents(const CanonicalMesh& mesh);

  // Nodes, splits and segments of a level in one or more events.
  std::vector<v1::SegmentEvent> OfLevel(const SegmentTree& tree,
                                        uint32_t level);

  // The splits of all nodes that OfLevel() gave without theirs, ascending.
  void AddLastSplits(const SegmentTree& tree, v1::Completed* completed) const;

 private:
  std::vector<v1::Node> ToNodes(const SegmentNode& node) const;

  const std::vector<uint32_t> point_of_vertex_;
  std::vector<uint32_t> decoded_faces_;  // of each canonical face
  size_t nodes_sent_ = 0;
  std::set<uint32_t> without_split_;
};

// The labels of one level in chunks; 0 is the cut.
std::vector<v1::SegmentEvent> LabelEvents(uint32_t level,
                                          v1::LabelDomain domain,
                                          const std::vector<uint32_t>& labels);

// The segments of a cut in one or more events.
std::vector<v1::SegmentEvent> CutEvents(const SegmentedMesh& mesh,
                                        const CutResult& cut);

// The skeleton of one level in one or more events; 0 is the cut.
std::vector<v1::SegmentEvent> SkeletonEvents(uint32_t level,
                                             const Skeleton& skeleton);

// Header, eigenvalues, certificate and eigenvectors of a spectrum, one event
// after another. Immutable, thread safe; holds what it needs.
class SpectrumEvents {
 public:
  // Header and eigenvalues alone.
  SpectrumEvents(std::shared_ptr<const CanonicalMesh> mesh,
                 const std::shared_ptr<const EigenPairs>& pairs);
  SpectrumEvents(std::shared_ptr<const CanonicalMesh> mesh,
                 std::shared_ptr<const CertifiedSpectrum> spectrum,
                 bool eigenvectors);

  uint64_t count() const {
    return kBeforeCertificate + (certified_ != nullptr) +
           pairs_sent_ * chunks_a_pair_;
  }
  // REQUIRES: index < count().
  v1::SpectrumEvent Make(uint64_t index) const;

 private:
  v1::SpectrumEvent Header() const;
  v1::SpectrumEvent Eigenvalues() const;
  v1::SpectrumEvent Certificate() const;
  v1::SpectrumEvent Chunk(uint32_t pair, uint64_t first_point) const;

  static constexpr uint64_t kBeforeCertificate = 2;

  const std::shared_ptr<const CanonicalMesh> mesh_;
  const Eigen::VectorXd eigenvalues_;
  const double area_;
  const std::shared_ptr<const CertifiedSpectrum> certified_;  // or null
  uint64_t pairs_sent_ = 0;
  uint64_t chunks_a_pair_ = 0;
};

}  // namespace marrow

#endif  // MARROW_SERVER_EVENT_BUILDER_H_
