#include "client/samples/parts.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace marrow {
namespace {

using Neighbours = std::vector<std::array<uint32_t, 3>>;

uint32_t NearestPart(const CreatureField& field, const Eigen::Vector3d& p) {
  const std::vector<double> distances = field.PartDistances(p);
  return static_cast<uint32_t>(
      std::min_element(distances.begin(), distances.end()) - distances.begin());
}

// The face across each of a face's three edges.
Neighbours NeighboursOfFaces(const SurfaceMesh& mesh) {
  struct Side {
    uint32_t low, high, face;
    int corner;
  };
  std::vector<Side> sides;
  for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t u = mesh.faces[f][i];
      const uint32_t v = mesh.faces[f][(i + 1) % 3];
      sides.push_back({std::min(u, v), std::max(u, v), f, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.face) < std::tie(y.low, y.high, y.face);
  });
  Neighbours result(mesh.faces.size());
  for (size_t i = 0; i + 1 < sides.size(); i += 2) {
    result[sides[i].face][sides[i].corner] = sides[i + 1].face;
    result[sides[i + 1].face][sides[i + 1].corner] = sides[i].face;
  }
  return result;
}

// The faces reached from `seed` without leaving its part, marked as seen.
std::vector<uint32_t> PieceAt(uint32_t seed, const std::vector<uint32_t>& parts,
                              const Neighbours& neighbours,
                              std::vector<bool>& seen) {
  std::vector<uint32_t> piece = {seed};
  seen[seed] = true;
  for (size_t i = 0; i < piece.size(); ++i) {
    for (uint32_t g : neighbours[piece[i]]) {
      if (seen[g] || parts[g] != parts[seed]) continue;
      seen[g] = true;
      piece.push_back(g);
    }
  }
  return piece;
}

// All pieces but the greatest of each part.
std::vector<std::vector<uint32_t>> Islands(const std::vector<uint32_t>& parts,
                                           const Neighbours& neighbours) {
  std::vector<bool> seen(parts.size(), false);
  std::map<uint32_t, std::vector<uint32_t>> greatest;
  std::vector<std::vector<uint32_t>> islands;
  for (uint32_t f = 0; f < parts.size(); ++f) {
    if (seen[f]) continue;
    std::vector<uint32_t> piece = PieceAt(f, parts, neighbours, seen);
    std::vector<uint32_t>& best = greatest[parts[f]];
    if (piece.size() > best.size()) std::swap(piece, best);
    if (!piece.empty()) islands.push_back(std::move(piece));
  }
  return islands;
}

void Flood(const std::vector<uint32_t>& island, const Neighbours& neighbours,
           std::vector<uint32_t>& parts) {
  const uint32_t own = parts[island.front()];
  for (uint32_t f : island) {
    for (uint32_t g : neighbours[f]) {
      if (parts[g] == own) continue;
      for (uint32_t member : island) parts[member] = parts[g];
      return;
    }
  }
}

}  // namespace

std::vector<uint32_t> PartsOfFaces(const CreatureField& field,
                                   const SurfaceMesh& mesh) {
  std::vector<uint32_t> parts;
  parts.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d sum =
        mesh.positions[a] + mesh.positions[b] + mesh.positions[c];
    parts.push_back(NearestPart(field, sum / 3));
  }
  const Neighbours neighbours = NeighboursOfFaces(mesh);
  for (const auto& island : Islands(parts, neighbours)) {
    Flood(island, neighbours, parts);
  }
  return parts;
}

}  // namespace marrow
