// SPDX-License-Identifier: MIT
#include "detail/mean_value_map.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {

bool has_mean_value_map() {
  return false;
}

std::vector<DiskPoint> mean_value_map(const std::vector<Vec3>&, const std::vector<Triangle>&,
                                      const std::vector<std::int32_t>&) {
  throw Error(
      "this pectinate was built without CGAL, so it cannot map surfaces to the disk; install CGAL (Debian: "
      "libcgal-dev) and build again with the CMake option -DPECTINATE_WITH_CGAL=ON, or use the interpolation by "
      "connection, which needs no map");
}

}  // namespace pectinate::detail
