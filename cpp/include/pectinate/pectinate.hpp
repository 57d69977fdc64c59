// SPDX-License-Identifier: MIT
#pragma once

#include "pectinate/comparison.hpp"
#include "pectinate/constraints.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/interpolation.hpp"
#include "pectinate/occupancy.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/parameterization.hpp"
#include "pectinate/placement.hpp"
#include "pectinate/reference_frame.hpp"
#include "pectinate/smoothing.hpp"
#include "pectinate/statistics.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"
#include "pectinate/tubes.hpp"
#include "pectinate/types.hpp"
