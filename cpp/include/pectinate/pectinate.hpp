// SPDX-License-Identifier: MIT
#pragma once

#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/occupancy.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/placement.hpp"
#include "pectinate/statistics.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"
#include "pectinate/tubes.hpp"
#include "pectinate/types.hpp"
