// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pectinate/types.hpp"

namespace pectinate {

struct WarpOptions {
  /// 0: every landmark goes exactly to its counterpart. More, and the map stays closer to an affine one; without unit,
  /// because the landmarks are measured by their spread.
  double stiffness = 0;
};

/// A smooth map of space that takes landmarks to landmarks: of all such maps the one that bends least (the thin-plate
/// spline of three dimensions: an affine map plus one multiple of the distance to each landmark).
struct LandmarkWarp {
  std::vector<Vec3> landmarks;  ///< as they were given
  std::vector<Vec3> weights;    ///< of the distance to each landmark
  std::array<Vec3, 3> linear;   ///< rows of the affine part's matrix
  Vec3 offset;                  ///< its image of the origin
};

/// Makes the map from `from` to `to`, one counterpart each. It does not depend on the order of the landmarks nor, both
/// sides together or apart, on where they lie, how they are turned and how large they are, but for rounding; affine
/// maps are reproduced.
///
/// Throws InvalidOption for: other counts; fewer than four landmarks, or all of `from` or all of `to` in one plane; two
/// landmarks of `from` in one place; coordinates that are not finite; a stiffness that is negative or not finite; and
/// landmarks whose affine part turns space inside out, because names of left and right are then exchanged.
LandmarkWarp make_landmark_warp(std::span<const Vec3> from, std::span<const Vec3> to, const WarpOptions& options = {});

/// Where points go. Throws InvalidOption for a point that is not finite.
std::vector<Vec3> warp_points(const LandmarkWarp& warp, std::span<const Vec3> points);

}  // namespace pectinate
