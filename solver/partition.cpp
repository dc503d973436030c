#include "solver/partition.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/error.hpp"
#include "solver/exchange.hpp"

namespace polyslip::solver {
namespace {

/// Gives elements[begin, end) to ranks [first, first + count).
void bisect(const std::vector<core::Vec3>& centroids, std::vector<int>& order, int begin, int end,
            int first, int count, std::vector<int>& rank) {
  if (count == 1) {
    for (int i = begin; i < end; ++i) rank[order[i]] = first;
    return;
  }
  core::Vec3 low = core::Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(centroids[order[i]]);
    high = high.cwiseMax(centroids[order[i]]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int left = count / 2;
  const int middle = begin + static_cast<int>(static_cast<long>(end - begin) * left / count);
  std::sort(order.begin() + begin, order.begin() + end, [&](int a, int b) {
    return centroids[a][axis] != centroids[b][axis] ? centroids[a][axis] < centroids[b][axis]
                                                    : a < b;
  });
  bisect(centroids, order, begin, middle, first, left, rank);
  bisect(centroids, order, middle, end, first + left, count - left, rank);
}

/// Rank 0's view of a distribution: numbers of every node and element.
struct Numbering {
  std::vector<int> owner;                           // [nodes] smallest rank that touches the node
  std::vector<PetscInt> global;                     // [nodes]
  std::vector<PetscInt> first_node, first_element;  // [ranks + 1]
  std::vector<std::vector<int>> nodes, elements;    // [ranks] as mesh numbers
};

Numbering number(const mesh::Mesh& mesh, const std::vector<int>& element_rank, int ranks) {
  Numbering n;
  const int nodes = mesh.node_count();
  n.owner.assign(nodes, ranks);
  n.elements.resize(ranks);
  std::vector<std::vector<int>> touched(ranks);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int r = element_rank[e];
    if (r < 0 || r >= ranks) throw core::InternalError("partition: rank out of range");
    n.elements[r].push_back(e);
    for (int node : mesh.tetrahedra[e]) {
      n.owner[node] = std::min(n.owner[node], r);
      touched[r].push_back(node);
    }
  }
  n.first_node.assign(ranks + 1, 0);
  n.first_element.assign(ranks + 1, 0);
  n.nodes.resize(ranks);
  for (int node = 0; node < nodes; ++node) {
    if (n.owner[node] == ranks) throw core::InternalError("partition: node without element");
    n.nodes[n.owner[node]].push_back(node);
  }
  n.global.assign(nodes, 0);
  for (int r = 0; r < ranks; ++r) {
    n.first_node[r + 1] = n.first_node[r] + static_cast<PetscInt>(n.nodes[r].size());
    n.first_element[r + 1] = n.first_element[r] + static_cast<PetscInt>(n.elements[r].size());
    for (std::size_t i = 0; i < n.nodes[r].size(); ++i)
      n.global[n.nodes[r][i]] = n.first_node[r] + static_cast<PetscInt>(i);
  }
  for (int r = 0; r < ranks; ++r) {
    auto& t = touched[r];
    std::sort(t.begin(), t.end());
    t.erase(std::unique(t.begin(), t.end()), t.end());
    std::vector<int> ghosts;
    for (int node : t)
      if (n.owner[node] != r) ghosts.push_back(node);
    std::sort(ghosts.begin(), ghosts.end(),
              [&](int a, int b) { return n.global[a] < n.global[b]; });
    n.nodes[r].insert(n.nodes[r].end(), ghosts.begin(), ghosts.end());
  }
  return n;
}

std::vector<std::uint8_t> domain_faces(const mesh::Mesh& mesh) {
  std::vector<std::uint8_t> faces(mesh.nodes.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int face = mesh.topology.faces[mesh.triangle_face[t]].domain_face;
    if (face < 0) continue;
    for (int node : mesh.triangles[t]) faces[node] |= static_cast<std::uint8_t>(1u << face);
  }
  return faces;
}

/// Mesh numbers of the two nodes whose mean a node is on the vertex level.
std::vector<std::array<int, 2>> parent_nodes(const mesh::Mesh& mesh) {
  std::vector<std::array<int, 2>> parents(mesh.nodes.size(), {-1, -1});
  for (const auto& t : mesh.tetrahedra) {
    for (int i = 0; i < 4; ++i) parents[t[i]] = {t[i], t[i]};
    for (int i = 0; i < 6; ++i) {
      const auto [a, b] = mesh::tetrahedron_edges[i];
      parents[t[4 + i]] = {std::min(t[a], t[b]), std::max(t[a], t[b])};
    }
  }
  return parents;
}

std::vector<double> pick(const std::vector<double>& values, const std::vector<int>& entities,
                         int components) {
  std::vector<double> picked;
  picked.reserve(entities.size() * components);
  for (int i : entities)
    for (int c = 0; c < components; ++c)
      picked.push_back(values[static_cast<std::size_t>(i) * components + c]);
  return picked;
}

/// Where in an ascending list of mesh numbers those from `first` to `last` - 1 stand.
std::pair<std::size_t, std::size_t> range_of(std::span<const int> entities, std::size_t first,
                                             std::size_t last) {
  const auto at = [&](std::size_t number) {
    return static_cast<std::size_t>(
        std::lower_bound(entities.begin(), entities.end(), static_cast<int>(number)) -
        entities.begin());
  };
  return {at(first), at(last)};
}

/// made(r), called on rank 0, arrives on rank r: one part after the other, so that rank 0 holds no
/// second copy of them all. Collective.
std::vector<double> hand_out(MPI_Comm comm,
                             const std::function<std::vector<double>(int rank)>& made) {
  constexpr int tag = 4;
  std::vector<double> part;
  if (rank_of(comm) == 0) {
    for (int r = 1; r < size_of(comm); ++r) {
      part = made(r);
      const auto count = static_cast<std::int64_t>(part.size());
      MPI_Send(&count, 1, MPI_INT64_T, r, tag, comm);
      MPI_Send(part.data(), message_size(part.size() * sizeof(double)), MPI_BYTE, r, tag, comm);
    }
    return made(0);
  }
  std::int64_t count = 0;
  MPI_Recv(&count, 1, MPI_INT64_T, 0, tag, comm, MPI_STATUS_IGNORE);
  part.resize(static_cast<std::size_t>(count));
  MPI_Recv(part.data(), message_size(part.size() * sizeof(double)), MPI_BYTE, 0, tag, comm,
           MPI_STATUS_IGNORE);
  return part;
}

}  // namespace

std::vector<int> bisect_elements(const mesh::Mesh& mesh, int ranks) {
  const int n = mesh.element_count();
  std::vector<core::Vec3> centroids(n);
  for (int e = 0; e < n; ++e) {
    const auto& t = mesh.tetrahedra[e];
    centroids[e] =
        0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]);
  }
  std::vector<int> order(n), rank(n, 0);
  std::iota(order.begin(), order.end(), 0);
  bisect(centroids, order, 0, n, 0, ranks, rank);
  return rank;
}

Distribution::Distribution(MPI_Comm comm, const mesh::Mesh& mesh,
                           const std::vector<int>& element_rank) {
  const int ranks = size_of(comm);
  std::vector<std::vector<PetscInt>> heads(ranks), globals(ranks), parents(ranks);
  std::vector<std::vector<int>> connectivity(ranks);
  std::vector<std::vector<std::uint8_t>> faces(ranks);
  on_root(comm, [&] {
    if (mesh.order != 2) throw core::InternalError("partition: the mesh has no mid nodes");
    Numbering n = number(mesh, element_rank, ranks);
    const auto node_faces = domain_faces(mesh);
    const auto parent = parent_nodes(mesh);
    std::vector<int> local_number(mesh.nodes.size(), -1);
    for (int r = 0; r < ranks; ++r) {
      heads[r] = {n.first_node[r], n.first_node[r + 1], n.first_node[ranks], n.first_element[r],
                  n.first_element[ranks]};
      for (std::size_t i = 0; i < n.nodes[r].size(); ++i) {
        const int node = n.nodes[r][i];
        local_number[node] = static_cast<int>(i);
        globals[r].push_back(n.global[node]);
        faces[r].push_back(node_faces[node]);
        if (n.owner[node] != r) continue;
        for (int end : parent[node]) parents[r].push_back(n.global[end]);
      }
      for (int e : n.elements[r])
        for (int node : mesh.tetrahedra[e]) connectivity[r].push_back(local_number[node]);
      owned_of_.push_back(static_cast<int>(n.first_node[r + 1] - n.first_node[r]));
    }
    nodes_of_ = std::move(n.nodes);
    elements_of_ = std::move(n.elements);
  });
  if (rank_of(comm) != 0) {
    nodes_of_.resize(ranks);
    elements_of_.resize(ranks);
  }
  const auto head = scatter(comm, heads);
  local_.comm = comm;
  local_.first_node = head[0];
  local_.owned_nodes = static_cast<int>(head[1] - head[0]);
  local_.global_nodes = head[2];
  local_.first_element = head[3];
  local_.global_elements = head[4];
  local_.node_global = scatter(comm, globals);
  local_.local_nodes = static_cast<int>(local_.node_global.size());
  local_.node_faces = scatter(comm, faces);
  local_.node_mesh = scatter(comm, nodes_of_);
  local_.element_mesh = scatter(comm, elements_of_);
  const auto flat = scatter(comm, connectivity);
  local_.elements.resize(flat.size() / 10);
  for (std::size_t i = 0; i < flat.size(); ++i) local_.elements[i / 10][i % 10] = flat[i];
  const auto ends = scatter(comm, parents);
  for (int i = 0; i < local_.owned_nodes; ++i) {
    local_.parents.push_back({ends[2 * i], ends[2 * i + 1]});
    local_.is_corner.push_back(ends[2 * i] == ends[2 * i + 1]);
  }
}

std::vector<double> Distribution::scatter_nodes(const std::vector<double>& values,
                                                int components) const {
  return hand_out(local_.comm, [&](int r) {
    return pick(values, nodes_of_[static_cast<std::size_t>(r)], components);
  });
}

std::vector<double> Distribution::scatter_elements(const std::vector<double>& values,
                                                   int components) const {
  return hand_out(local_.comm, [&](int r) {
    return pick(values, elements_of_[static_cast<std::size_t>(r)], components);
  });
}

AppendRows rows_of(const std::vector<double>& values, std::size_t each) {
  return [&values, each](std::size_t first, std::size_t last, std::vector<double>& out) {
    out.insert(out.end(), values.begin() + static_cast<std::ptrdiff_t>(first * each),
               values.begin() + static_cast<std::ptrdiff_t>(last * each));
  };
}

std::vector<double> Distribution::gather_nodes(const std::vector<double>& values,
                                               int components) const {
  const auto each = static_cast<std::size_t>(components);
  return gather_node_rows(rows_of(values, each), 0, static_cast<std::size_t>(local_.global_nodes),
                          each);
}

std::vector<double> Distribution::gather_elements(const std::vector<double>& values,
                                                  int components) const {
  const auto each = static_cast<std::size_t>(components);
  return gather_element_rows(rows_of(values, each), 0,
                             static_cast<std::size_t>(local_.global_elements), each);
}

std::vector<double> Distribution::gather_node_rows(const AppendRows& append, std::size_t first,
                                                   std::size_t last, std::size_t each) const {
  const std::span<const int> all(local_.node_mesh);
  return gather_rows(append, all.first(static_cast<std::size_t>(local_.owned_nodes)), true, first,
                     last, each);
}

std::vector<double> Distribution::gather_element_rows(const AppendRows& append, std::size_t first,
                                                      std::size_t last, std::size_t each) const {
  return gather_rows(append, local_.element_mesh, false, first, last, each);
}

std::vector<double> Distribution::gather_rows(const AppendRows& append, std::span<const int> mine,
                                              bool nodes, std::size_t first, std::size_t last,
                                              std::size_t each) const {
  const auto [from, to] = range_of(mine, first, last);
  std::vector<double> sent;
  sent.reserve((to - from) * each);
  append(from, to, sent);
  const auto parts = gather(local_.comm, sent);
  if (parts.empty()) return {};
  std::vector<double> values((last - first) * each);
  for (std::size_t r = 0; r < parts.size(); ++r) {
    std::span<const int> theirs = nodes ? nodes_of_[r] : elements_of_[r];
    if (nodes) theirs = theirs.first(static_cast<std::size_t>(owned_of_[r]));
    const auto [begin, end] = range_of(theirs, first, last);
    for (std::size_t i = begin; i < end; ++i)
      std::copy_n(parts[r].begin() + static_cast<std::ptrdiff_t>((i - begin) * each), each,
                  values.begin() + static_cast<std::ptrdiff_t>(
                                       (static_cast<std::size_t>(theirs[i]) - first) * each));
  }
  return values;
}

NodeExchange::NodeExchange(const LocalMesh& local, Profile* profile)
    : comm_(local.comm), profile_(profile) {
  const int ranks = size_of(comm_), me = rank_of(comm_);
  std::vector<PetscInt> first(static_cast<std::size_t>(ranks) + 1);
  MPI_Allgather(&local.first_node, 1, MPIU_INT, first.data(), 1, MPIU_INT, comm_);
  first[ranks] = local.global_nodes;
  std::vector<std::vector<PetscInt>> wanted(ranks);
  std::vector<std::vector<int>> ghosts(ranks);
  for (int i = local.owned_nodes; i < local.local_nodes; ++i) {
    const auto after = std::upper_bound(first.begin(), first.end(), local.node_global[i]);
    const auto owner = static_cast<std::size_t>(after - first.begin() - 1);
    wanted[owner].push_back(local.node_global[i]);
    ghosts[owner].push_back(i);
  }
  std::vector<int> everyone;
  std::vector<std::vector<PetscInt>> out;
  for (int r = 0; r < ranks; ++r) {
    if (r == me) continue;
    everyone.push_back(r);
    out.push_back(wanted[r]);
  }
  const auto asked = exchange(comm_, everyone, out);
  for (std::size_t k = 0; k < everyone.size(); ++k) {
    if (asked[k].empty() && out[k].empty()) continue;
    neighbours_.push_back(everyone[k]);
    ghosts_of_.push_back(ghosts[everyone[k]]);
    std::vector<int> seen;
    for (PetscInt g : asked[k]) seen.push_back(static_cast<int>(g - local.first_node));
    seen_by_.push_back(std::move(seen));
  }
}

NodeExchange::NodeExchange(const NodeExchange& all, const std::vector<int>& number)
    : comm_(all.comm_), profile_(all.profile_) {
  const auto numbers = [&](const std::vector<int>& nodes) {
    std::vector<int> kept;
    for (int n : nodes)
      if (number[n] >= 0) kept.push_back(number[n]);
    return kept;
  };
  for (std::size_t k = 0; k < all.neighbours_.size(); ++k) {
    auto seen = numbers(all.seen_by_[k]), ghosts = numbers(all.ghosts_of_[k]);
    if (seen.empty() && ghosts.empty()) continue;
    neighbours_.push_back(all.neighbours_[k]);
    seen_by_.push_back(std::move(seen));
    ghosts_of_.push_back(std::move(ghosts));
  }
}

std::vector<char> NodeExchange::pass(const char* values, std::size_t size, const Lists& out,
                                     const Lists& in) const {
  const Stage stage(profile_, "exchange of nodes");
  const auto count = [](const Lists& lists) {
    std::size_t n = 0;
    for (const auto& list : lists) n += list.size();
    return n;
  };
  std::vector<char> sent(count(out) * size), received(count(in) * size);
  std::vector<MPI_Request> requests;
  std::size_t at = 0;
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    if (in[k].empty()) continue;
    const std::size_t bytes = in[k].size() * size;
    MPI_Irecv(received.data() + at, message_size(bytes), MPI_BYTE, neighbours_[k], 3, comm_,
              &requests.emplace_back());
    at += bytes;
  }
  char* to = sent.data();
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    if (out[k].empty()) continue;
    const char* begin = to;
    for (int node : out[k]) {
      std::memcpy(to, values + static_cast<std::size_t>(node) * size, size);
      to += size;
    }
    const auto bytes = static_cast<std::size_t>(to - begin);
    MPI_Isend(begin, message_size(bytes), MPI_BYTE, neighbours_[k], 3, comm_,
              &requests.emplace_back());
    if (profile_) profile_->count_message(bytes);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return received;
}

void NodeExchange::move(void* values, std::size_t size) const {
  if (neighbours_.empty()) return;
  char* bytes = static_cast<char*>(values);
  const std::vector<char> received = pass(bytes, size, seen_by_, ghosts_of_);
  const char* from = received.data();
  for (const auto& nodes : ghosts_of_)
    for (int node : nodes) {
      std::memcpy(bytes + static_cast<std::size_t>(node) * size, from, size);
      from += size;
    }
}

}  // namespace polyslip::solver
