// Minimum cuts of small undirected graphs.
#ifndef MARROW_CORE_BOUNDARIES_MIN_CUT_H_
#define MARROW_CORE_BOUNDARIES_MIN_CUT_H_

#include <cstdint>
#include <vector>

namespace marrow {

// Where a graph between a source and a sink is cut at least cost. Finds the
// flow along shortest paths, phase by phase (Dinic 1970): as bands on a surface
// are a few dozen faces wide, phases are few. Deterministic. Not thread safe.
class MinCut {
 public:
  enum class Side { kSource, kSink, kNeither };

  explicit MinCut(uint32_t num_nodes);

  // Costs at least 0; several edges between two nodes add up.
  void Connect(uint32_t a, uint32_t b, double cost);
  void ConnectToSource(uint32_t node, double cost);
  void ConnectToSink(uint32_t node, double cost);

  // The side of each node; of all cuts of least cost, the one whose source side
  // is smallest. kNeither where neither terminal can be reached through edges.
  std::vector<Side> Solve();

 private:
  struct Arc {
    uint32_t to;
    double room;  // for more flow; the arc that goes back is arc ^ 1
  };

  void AddArcs(uint32_t from, uint32_t to, double room, double room_back);
  void Sort();
  bool FindLevels();
  void Augment();
  void Push(std::vector<uint32_t>& path);
  std::vector<bool> TouchSink() const;

  uint32_t source_, sink_;
  double least_room_ = 0;
  std::vector<Arc> arcs_;
  // Arcs by the node they leave: out_[first_[u]] to out_[first_[u + 1]].
  std::vector<uint32_t> first_, out_;
  std::vector<uint32_t> level_, next_;  // next_: the first arc worth a look
};

}  // namespace marrow

#endif  // MARROW_CORE_BOUNDARIES_MIN_CUT_H_
