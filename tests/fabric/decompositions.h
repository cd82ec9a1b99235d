#pragma once
/// \file
/// What the tests want of Eigen's decompositions, which take long to compile: once, in decompositions.cpp.

#include <Eigen/Core>

namespace percale::test {

struct Spectrum {
  Eigen::VectorXd values;   ///< Ascending.
  Eigen::MatrixXd vectors;  ///< A column each, of length 1.
};

/// Of a symmetric matrix.
Spectrum SpectrumOf(const Eigen::MatrixXd& a);
/// The eigenvalues of A x = lambda B x, ascending; A is symmetric, B symmetric and positive definite.
Eigen::VectorXd EigenvaluesOf(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& a);
/// x of A x = b; A is symmetric.
Eigen::VectorXd SolutionOf(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace percale::test
