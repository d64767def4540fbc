#include "calib/normal_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace duo {

Eigen::MatrixXd solve_normal(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double* weakest) {
  const Eigen::LDLT<Eigen::MatrixXd> solver(a);
  if (weakest != nullptr) *weakest = solver.info() == Eigen::Success ? solver.vectorD().minCoeff() : -1;
  return solver.solve(b);
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace duo
