// Normal equations of least squares, of any size, solved in one place: each fixed size of Eigen's would be compiled by itself.
#pragma once

#include <Eigen/Core>

namespace duo {

/// x of a x = b for each column of b, by a = P^T L D L^T P; parts of b along which a is 0 are left out of x.
///
/// a  n x n, symmetric, not negative
/// b  n x any
/// weakest  where not null: the smallest of D, at or below 0 where a determines less than n unknowns
Eigen::MatrixXd solve_normal(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double* weakest = nullptr);

/// The covariance of the solution; not finite where a determines less than n unknowns.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a);

}  // namespace duo
