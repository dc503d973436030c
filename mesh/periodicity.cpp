#include "mesh/periodicity.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "core/file.hpp"
#include "mesh/mesh.hpp"

namespace polyslip::mesh {

std::vector<int> pair_of_slave(const std::vector<PeriodicPair>& pairs, int count) {
  std::vector<int> found(count, -1);
  for (std::size_t i = 0; i < pairs.size(); ++i) found[pairs[i].slave] = static_cast<int>(i);
  return found;
}

void write_periodic_nodes(const Mesh& mesh, const std::string& path) {
  std::string text = "slave,master,shift_x,shift_y,shift_z\n";
  for (const auto& [slave, master, shift] : mesh.periodic_nodes)
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", slave + 1, master + 1, shift[0],
                   shift[1], shift[2]);
  core::write_file(path, text);
}

}  // namespace polyslip::mesh
