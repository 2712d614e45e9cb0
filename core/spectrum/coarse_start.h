// Approximate eigenvectors from a much smaller problem: where bands begin.
#ifndef MARROW_CORE_SPECTRUM_COARSE_START_H_
#define MARROW_CORE_SPECTRUM_COARSE_START_H_

#include <Eigen/SparseCore>
#include <vector>

namespace marrow {

// A graph's Voronoi cells about well-spread seeds, and the operator on them.
struct CoarseProblem {
  // Cell of every unknown of the fine problem.
  std::vector<int> cell;
  // The square root of a cell's mass; the coarse vectors times its inverse are
  // the values of a function.
  std::vector<double> sqrt_mass;
  Eigen::SparseMatrix<double> matrix;  // symmetric form, as the fine one
  std::vector<double> positions;       // of the seeds, three each
};

// About `cells` cells. The fine problem is D L D with D = M^-1/2 as
// `inverse_sqrt_mass`; `positions` has a row of three an unknown. The flux
// between two cells is that between their seeds, over the edges that cross.
// Linear but for a logarithm; deterministic. The matrix is positive
// semi-definite, with the constants in its kernel.
CoarseProblem MakeCoarseProblem(const Eigen::SparseMatrix<double>& matrix,
                                const Eigen::VectorXd& inverse_sqrt_mass,
                                const double* positions, int cells);

// The lowest vectors of the coarse problem as functions on the cells.
struct CoarseStart {
  std::vector<int> cell;  // of the unknowns, in the fine structure's order
  std::vector<double> sqrt_mass;  // of the unknowns, likewise
  int count = 0;                  // vectors
  std::vector<float> values;      // a row a cell

  // Writes vectors first, first + 1, ... of a block; those that there are not
  // are left as they are.
  void Fill(int first, double* X) const;
};

}  // namespace marrow

#endif  // MARROW_CORE_SPECTRUM_COARSE_START_H_
