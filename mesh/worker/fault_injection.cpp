#include "mesh/worker/fault_injection.hpp"

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "mesh/mesher_protocol.hpp"

namespace polyslip::mesh::worker {

FaultInjection FaultInjection::from_environment() {
  FaultInjection result;
  const char* text = std::getenv("POLYSLIP_MESHER_FAULT");
  std::istringstream list(text ? text : "");
  for (std::string item; std::getline(list, item, ',');) {
    std::istringstream parts(item);
    Entry entry;
    std::string grain;
    if (!std::getline(parts, entry.mesher, ':') || !std::getline(parts, grain, ':') ||
        !std::getline(parts, entry.kind))
      continue;
    entry.grain = std::atoi(grain.c_str());
    result.entries_.push_back(entry);
  }
  return result;
}

bool FaultInjection::asked(const std::string& mesher, int grain, const std::string& kind) const {
  for (const auto& entry : entries_)
    if (entry.mesher == mesher && entry.grain == grain && entry.kind == kind) return true;
  return false;
}

int FaultInjection::refused_forks() const {
  for (const auto& entry : entries_)
    if (entry.mesher == "fork" && entry.kind == "refuse") return entry.grain;
  return 0;
}

void FaultInjection::before(const std::string& mesher, int grain) const {
  if (asked(mesher, grain, "crash")) std::raise(SIGSEGV);
  if (asked(mesher, grain, "throw")) throw std::runtime_error("asked to throw");
  if (asked(mesher, grain, "hang"))
    for (std::atomic<int> turns{0};; ++turns) {
    }
}

bool FaultInjection::unoptimised(const std::string& mesher, int grain) const {
  return asked(mesher, grain, "unoptimised");
}

void FaultInjection::after(const std::string& mesher, int grain, VolumeMesh& mesh,
                           int socket) const {
  if (asked(mesher, grain, "nan")) mesh.nodes.back().x() = std::numeric_limits<double>::quiet_NaN();
  if (asked(mesher, grain, "move"))
    mesh.nodes.front().x() = std::nextafter(mesh.nodes.front().x(), 1e300);
  if (asked(mesher, grain, "garbage")) protocol::send_all(socket, protocol::Bytes(1000, 'x'));
}

void FaultInjection::after(const std::string& mesher, int face, PlanarMesh& mesh,
                           int socket) const {
  if (asked(mesher, face, "nan")) mesh.points.back().x() = std::numeric_limits<double>::quiet_NaN();
  if (asked(mesher, face, "move"))
    mesh.points.front().x() = std::nextafter(mesh.points.front().x(), 1e300);
  if (asked(mesher, face, "garbage")) protocol::send_all(socket, protocol::Bytes(1000, 'x'));
}

}  // namespace polyslip::mesh::worker
