#include "client/samples/samples.h"

#include <algorithm>
#include <cmath>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/samples/creature.h"
#include "client/samples/field.h"
#include "client/samples/parts.h"
#include "client/samples/polygonize.h"
#include "client/samples/pose.h"
#include "client/samples/remesh.h"
#include "core/base/status_macros.h"

namespace marrow {
namespace {

// Collapsing needs more faces than it shall leave; and below some fineness,
// the gaps between limbs would close.
constexpr double kFacesBeforeCollapse = 3;
constexpr double kLeastFacesBeforeCollapse = 40000;
constexpr double kTrialCellsAcross = 60;
// Edges that could not be collapsed among the first ragged triangles can be
// once these are smooth.
constexpr double kFacesBeforeLastPass = 1.2;
constexpr int kRelaxRounds = 6;

const std::vector<Creature>& Creatures() {
  static const auto& creatures = *new std::vector<Creature>{
      MakeHumanoid(), MakeQuadruped(), MakeHand(), MakeOctopus()};
  return creatures;
}

template <typename T>
const T* FindByName(const std::vector<T>& items, const std::string& name) {
  const auto it = std::find_if(items.begin(), items.end(),
                               [&](const T& x) { return x.name == name; });
  return it == items.end() ? nullptr : &*it;
}

template <typename T>
std::string NamesOf(const std::vector<T>& items) {
  return absl::StrJoin(items, ", ", [](std::string* out, const T& item) {
    absl::StrAppend(out, item.name);
  });
}

// The number of faces grows with the inverse square of the cell's side, so a
// coarse trial tells which side gives how many.
SurfaceMesh PolygonizeWithAtLeast(double faces, const CreatureField& field) {
  const double trial = field.bounds().diagonal().norm() / kTrialCellsAcross;
  const auto trial_faces =
      static_cast<double>(Polygonize(field, trial).faces.size());
  return Polygonize(field, trial * std::sqrt(trial_faces / faces));
}

absl::StatusOr<SurfaceMesh> MakeSkin(const CreatureField& field,
                                     uint32_t faces) {
  SurfaceMesh mesh = PolygonizeWithAtLeast(
      std::max(kFacesBeforeCollapse * faces, kLeastFacesBeforeCollapse), field);
  const auto nearly = static_cast<uint32_t>(kFacesBeforeLastPass * faces);
  MARROW_RETURN_IF_ERROR(CollapseTo(nearly - nearly % 2, field, mesh));
  Relax(field, kRelaxRounds, mesh);
  MARROW_RETURN_IF_ERROR(CollapseTo(faces, field, mesh));
  Relax(field, kRelaxRounds, mesh);
  return mesh;
}

PolygonMesh ToPolygonMesh(const std::vector<Eigen::Vector3d>& positions,
                          const std::vector<std::array<uint32_t, 3>>& faces) {
  PolygonMesh mesh;
  for (const Eigen::Vector3d& p : positions) {
    mesh.positions.push_back({static_cast<float>(p.x()),
                              static_cast<float>(p.y()),
                              static_cast<float>(p.z())});
  }
  for (const auto& face : faces) mesh.AddFace(face);
  return mesh;
}

}  // namespace

const std::vector<SampleInfo>& ListSamples() {
  static const auto& infos = *[] {
    auto* list = new std::vector<SampleInfo>;
    for (const Creature& creature : Creatures()) {
      SampleInfo& info = list->emplace_back();
      info.name = creature.name;
      info.description = creature.description;
      for (const CreaturePose& pose : creature.poses) {
        info.poses.push_back(pose.name);
      }
    }
    return list;
  }();
  return infos;
}

absl::StatusOr<Sample> MakeSample(const std::string& name,
                                  const std::string& pose, uint32_t faces) {
  const Creature* creature = FindByName(Creatures(), name);
  if (creature == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat("there is no sample \"",
                                                   name, "\"; choose one of ",
                                                   NamesOf(Creatures())));
  }
  const CreaturePose* stance =
      FindByName(creature->poses, pose.empty() ? "rest" : pose);
  if (stance == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("sample \"", name, "\" has no pose \"", pose,
                     "\"; choose one of ", NamesOf(creature->poses)));
  }
  if (faces < kMinSampleFaces || faces > kMaxSampleFaces) {
    return absl::InvalidArgumentError(
        absl::StrCat("a sample can have ", kMinSampleFaces, " to ",
                     kMaxSampleFaces, " faces, not ", faces));
  }
  const CreatureField field(*creature);
  MARROW_ASSIGN_OR_RETURN(const SurfaceMesh skin,
                          MakeSkin(field, faces - faces % 2));
  Sample sample;
  sample.mesh = ToPolygonMesh(
      PosePoints(*creature, field, *stance, skin.positions), skin.faces);
  sample.face_parts = PartsOfFaces(field, skin);
  for (const CreaturePart& part : creature->parts) {
    sample.part_names.push_back(part.name);
  }
  return sample;
}

}  // namespace marrow
