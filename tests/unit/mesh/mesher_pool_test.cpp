#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "core/error.hpp"
#include "mesh/candidate.hpp"
#include "mesh/tetrahedral_optimiser.hpp"
#include "mesh/volume_mesher.hpp"
#include "surfaces.hpp"

namespace polyslip::mesh {
namespace {

const std::string worker = POLYSLIP_BINARY_DIR "/polyslip-mesher";
const std::vector<std::string> all_meshers(known_meshers.begin(), known_meshers.end());

/// `faults` as in POLYSLIP_MESHER_FAULT.
std::unique_ptr<MesherPool> start_pool(const std::string& faults = "") {
  setenv("POLYSLIP_MESHER_FAULT", faults.c_str(), 1);
  auto pool = MesherPool::start(worker);
  unsetenv("POLYSLIP_MESHER_FAULT");
  return pool;
}

/// Ellipsoids that all differ a little.
std::vector<GrainRequest> ellipsoids(int count) {
  std::vector<GrainRequest> requests;
  for (int i = 0; i < count; ++i)
    requests.push_back(
        {i, test::ellipsoid_surface(2, core::Vec3(0.6 + 0.01 * (i % 17), 0.6 - 0.005 * (i % 11),
                                                  0.6 + 0.013 * (i % 7)))});
  return requests;
}

bool identical(const VolumeMesh& a, const VolumeMesh& b) {
  return a.nodes.size() == b.nodes.size() && a.tetrahedra == b.tetrahedra &&
         std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), [](auto& x, auto& y) {
           return std::memcmp(x.data(), y.data(), 3 * sizeof(double)) == 0;
         });
}

void expect_identical(const std::vector<GrainResult>& a, const std::vector<GrainResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(a[i].ok) << i;
    EXPECT_TRUE(identical(a[i].mesh, b[i].mesh)) << i;
    EXPECT_EQ(a[i].mesher, b[i].mesher);
    EXPECT_EQ(a[i].O, b[i].O);
    EXPECT_EQ(a[i].faults, b[i].faults);
  }
}

class EveryMesher : public testing::TestWithParam<std::string> {};

TEST_P(EveryMesher, FillsShapesAndKeepsTheirSurface) {
  const std::vector<GrainRequest> requests{
      {7, test::cube_surface(3, 1.0)},
      {8, test::ellipsoid_surface(2, core::Vec3(1, 1, 1))},
      {9, test::notched_surface(2, 1.4)},
      {3, test::ellipsoid_surface(2, core::Vec3(1, 0.9, 0.25))},
      {4, test::ellipsoid_surface(0, core::Vec3(0.3, 0.3, 0.3))}};
  PoolOptions options;
  options.meshers = {GetParam()};
  options.element_size = 0.4;
  const auto results = start_pool()->mesh(requests, options);
  ASSERT_EQ(results.size(), requests.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    ASSERT_TRUE(results[i].ok) << i << testing::PrintToString(results[i].faults);
    EXPECT_TRUE(results[i].faults.empty());
    EXPECT_EQ(results[i].grain, requests[i].grain);
    EXPECT_EQ(results[i].mesher, GetParam());
    EXPECT_EQ(validate(requests[i].surface, results[i].mesh), "");
    EXPECT_EQ(results[i].O, mesh_quality_O(results[i].mesh, 0.4));
    EXPECT_GT(results[i].O, GetParam() == "paper-1" ? 0.1 : 0.4);
    EXPECT_GT(min_radius_ratio(results[i].mesh), 0.02);
  }
  EXPECT_GT(results[1].mesh.nodes.size(), requests[1].surface.nodes.size());
}

TEST_P(EveryMesher, GivesTheSameForAnyNumberOfJobsAndAgain) {
  const auto requests = ellipsoids(30);  // two batches
  PoolOptions options;
  options.meshers = {GetParam()};
  options.jobs = 1;
  const auto pool = start_pool();
  const auto one = pool->mesh(requests, options);
  for (const int jobs : {2, 3, 1}) {
    options.jobs = jobs;
    expect_identical(one, pool->mesh(requests, options));
  }
  expect_identical(one, start_pool()->mesh(requests, options));
  EXPECT_GT(pool->cpu_seconds(), 0);
}

TEST_P(EveryMesher, GivesAGrainTheSameMeshInAnyCompanyAndEnvironment) {
  const auto requests = ellipsoids(8);
  auto reversed = requests;
  std::reverse(reversed.begin(), reversed.end());
  PoolOptions options;
  options.meshers = {GetParam()};
  const auto forward = start_pool()->mesh(requests, options);
  setenv("POLYSLIP_TEST_PADDING", std::string(5000, 'x').c_str(), 1);
  auto backward = start_pool()->mesh(reversed, options);
  unsetenv("POLYSLIP_TEST_PADDING");
  std::reverse(backward.begin(), backward.end());
  expect_identical(forward, backward);
}

INSTANTIATE_TEST_SUITE_P(Pool, EveryMesher, testing::ValuesIn(all_meshers), [](const auto& tested) {
  std::string name = tested.param;
  std::erase(name, '-');
  return name;
});

TEST(MesherPool, AsksForGrainsWhenItNeedsThem) {
  auto requests = ellipsoids(80);
  requests[3].surface.nodes[0][1] = std::nan("");  // never reaches a mesher
  const auto pool = start_pool();
  PoolOptions options;
  options.meshers = {"gmsh-hxt", "gmsh-delaunay"};
  const auto together = pool->mesh(requests, options);
  for (const int jobs : {1, 3}) {
    options.jobs = jobs;
    std::size_t asked = 0, got = 0, asked_at_first_result = 0;
    std::vector<GrainResult> results(requests.size());
    pool->mesh(
        requests.size(),
        [&](std::size_t place) {
          EXPECT_EQ(place, asked++);
          return requests[place];
        },
        [&](std::size_t place, GrainResult&& result) {
          if (result.ok && asked_at_first_result == 0) asked_at_first_result = asked;
          EXPECT_EQ(result.grain, static_cast<int>(place));
          results[place] = std::move(result);
          ++got;
        },
        options);
    EXPECT_EQ(asked, 80u);
    EXPECT_EQ(got, 80u);
    if (jobs == 1) {
      EXPECT_LT(asked_at_first_result, 80u);
    }
    EXPECT_FALSE(results[3].ok);
    EXPECT_EQ(results[3].faults, together[3].faults);
    results[3] = results[4];
    auto expected = together;
    expected[3] = expected[4];
    expect_identical(expected, results);
  }
}

TEST(MesherPool, StopsWhenAGrainCannotBeAskedFor) {
  const auto requests = ellipsoids(60);
  const auto pool = start_pool();
  const auto source = [&](std::size_t place) -> GrainRequest {
    if (place == 55) throw core::RecoverableError("no such grain");
    return requests[place];
  };
  EXPECT_THROW(pool->mesh(60, source, [](std::size_t, GrainResult&&) {}, {}),
               core::RecoverableError);
  EXPECT_TRUE(pool->mesh(ellipsoids(1), {})[0].ok);
}

TEST(MesherPool, TakesTheBestCandidate) {
  const auto requests = ellipsoids(6);
  const auto pool = start_pool();
  PoolOptions options;
  options.target = 1;
  const auto best = pool->mesh(requests, options);
  const auto rank = [](const GrainResult& result) {
    const double worst = std::min(min_radius_ratio(result.mesh), 0.2);
    return std::pair(static_cast<int>(worst / 0.02), result.O);
  };
  for (const auto& name : PoolOptions{}.meshers) {
    options.meshers = {name};
    const auto alone = pool->mesh(requests, options);
    for (std::size_t i = 0; i < best.size(); ++i) {
      ASSERT_TRUE(alone[i].ok);
      EXPECT_GE(rank(best[i]), rank(alone[i]));
      EXPECT_EQ(best[i].mesher == name, identical(best[i].mesh, alone[i].mesh));
    }
  }
}

TEST(MesherPool, TriesFurtherMeshersOnlyWhereTheFirstIsNotGoodEnough) {
  auto requests = ellipsoids(6);
  requests[2].surface = test::ellipsoid_surface(2, core::Vec3(0.6, 0.6, 0.1));
  const auto pool = start_pool();
  PoolOptions options;
  options.meshers = {"paper-1", "gmsh-hxt"};
  const auto both = pool->mesh(requests, options);
  options.meshers = {"paper-1"};
  const auto first = pool->mesh(requests, options);
  int kept = 0, tried = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto bounds = surface_bounds(requests[i].surface, options.element_size);
    const bool good = is_good(bounds, min_radius_ratio(first[i].mesh), first[i].O, options.target);
    ASSERT_TRUE(both[i].ok);
    EXPECT_TRUE(!good || identical(both[i].mesh, first[i].mesh));
    (good ? kept : tried) += 1;
    EXPECT_GE(both[i].O, std::min(first[i].O, 0.4));
  }
  EXPECT_GT(tried, 0);
  options.meshers = {"gmsh-hxt", "gmsh-delaunay"};
  options.target = 0.01;
  for (const auto& result : pool->mesh(ellipsoids(6), options))
    EXPECT_EQ(result.mesher, "gmsh-hxt");
}

TEST(MesherPool, LeavesOutOurOptimiserIfAsked) {
  const auto pool = MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  const auto requests = ellipsoids(4);
  PoolOptions options;
  options.meshers = {"gmsh-hxt"};
  const auto optimised = pool->mesh(requests, options);
  options.optimise = false;
  const auto left = pool->mesh(requests, options);
  int differ = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    ASSERT_TRUE(optimised[i].ok && left[i].ok);
    EXPECT_EQ(left[i].mesher, "gmsh-hxt");
    EXPECT_TRUE(identical(optimised[i].mesh, optimise_inside(requests[i].surface, left[i].mesh)));
    differ += !identical(optimised[i].mesh, left[i].mesh);
  }
  EXPECT_GT(differ, 0);
}

struct Fault {
  std::string kind, text;
};

class InjectedFault : public testing::TestWithParam<Fault> {};

TEST_P(InjectedFault, CostsOneCandidate) {
  const auto requests = ellipsoids(8);
  PoolOptions options;
  options.meshers = {"gmsh-delaunay", "gmsh-hxt"};
  options.target = 1;  // both meshers try each grain
  options.timeout = 2;
  const auto pool = start_pool("gmsh-hxt:3:" + GetParam().kind);
  options.jobs = 1;
  const auto one = pool->mesh(requests, options);
  for (const auto& result : one) {
    EXPECT_TRUE(result.ok);
    EXPECT_EQ(result.faults.size(), result.grain == 3 ? 1U : 0U);
  }
  ASSERT_EQ(one[3].faults.size(), 1U);
  EXPECT_EQ(one[3].faults[0].find("mesher 'gmsh-hxt', grain 4: "), 0U);
  EXPECT_NE(one[3].faults[0].find(GetParam().text), std::string::npos) << one[3].faults[0];
  EXPECT_EQ(one[3].mesher, "gmsh-delaunay");
  if (GetParam().kind == "hang") return;
  for (const int jobs : {2, 3}) {
    options.jobs = jobs;
    expect_identical(one, pool->mesh(requests, options));
  }
}

INSTANTIATE_TEST_SUITE_P(Pool, InjectedFault,
                         testing::Values(Fault{"crash", "killed by signal 11 (Segmentation fault)"},
                                         Fault{"hang", "killed after 2 s of CPU"},
                                         Fault{"throw", "exception: asked to throw"},
                                         Fault{"nan", "is not finite"},
                                         Fault{"move", "surface node 0 has moved"},
                                         Fault{"garbage", "garbage for an answer (not a header)"}),
                         [](const auto& tested) { return tested.param.kind; });

TEST(MesherPool, AGrainWithoutAnyMeshIsNotOk) {
  auto requests = ellipsoids(5);
  for (auto& t : requests[4].surface.triangles) std::swap(t[0], t[1]);
  requests[0].surface.nodes[5].x() = std::numeric_limits<double>::quiet_NaN();
  requests[1].surface.triangles.pop_back();  // not closed
  requests[2].surface.triangles[0][0] = 1000;
  PoolOptions options;
  options.timeout = 5;
  const auto results = start_pool()->mesh(requests, options);
  for (const int i : {0, 1, 2, 4}) {
    EXPECT_FALSE(results[i].ok);
    EXPECT_FALSE(results[i].faults.empty());
    EXPECT_TRUE(results[i].mesh.tetrahedra.empty());
  }
  EXPECT_EQ(results[0].faults[0], "grain 1: node 5 of its surface is not finite");
  EXPECT_EQ(results[1].faults.size(), 3U);
  EXPECT_EQ(results[4].faults[0].find("grain 5: its surface is inside out"), 0U);
  EXPECT_TRUE(results[3].ok);
  EXPECT_TRUE(results[3].faults.empty());
}

TEST(MesherPool, RefusesWrongOptions) {
  const auto pool = start_pool();
  PoolOptions options;
  options.meshers = {"tetgen"};
  EXPECT_THROW(pool->mesh({}, options), core::InputError);
  options.meshers.clear();
  EXPECT_THROW(pool->mesh({}, options), core::InputError);
  options = {};
  options.element_size = 0;
  EXPECT_THROW(pool->mesh({}, options), core::InputError);
  EXPECT_TRUE(pool->mesh({}, PoolOptions{}).empty());
}

TEST(MesherPool, SaysThatTheProgramIsMissing) {
  const auto pool = MesherPool::start("/nowhere/polyslip-mesher");
  try {
    pool->mesh(ellipsoids(1), PoolOptions{});
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/polyslip-mesher: No such file"),
              std::string::npos)
        << error.what();
  }
}

/// Processes whose parent is `parent`; zombies excluded.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "stat");
    std::string text;
    std::getline(in, text);
    const auto end = text.rfind(')');
    if (end == std::string::npos) continue;
    char state = 0;
    int ppid = 0;
    if (std::sscanf(text.c_str() + end + 1, " %c %d", &state, &ppid) == 2 && ppid == parent &&
        state != 'Z')
      found.push_back(std::atoi(text.c_str()));
  }
  return found;
}

template <class Condition>
bool eventually(Condition&& condition) {
  for (int i = 0; i < 500; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

TEST(MesherPool, SaysThatItsProcessWasKilled) {
  const auto pool = start_pool("gmsh-hxt:0:hang");
  const auto servers = children_of(getpid());
  ASSERT_EQ(servers.size(), 1U);
  std::thread killer([&] {
    EXPECT_TRUE(eventually([&] { return !children_of(servers[0]).empty(); }));
    kill(servers[0], SIGKILL);
  });
  std::string text;
  try {
    pool->mesh(ellipsoids(2), PoolOptions{});
  } catch (const core::InternalError& error) {
    text = error.what();
  }
  killer.join();
  EXPECT_NE(text.find("polyslip-mesher was killed by signal 9"), std::string::npos) << text;
  EXPECT_THROW(pool->mesh(ellipsoids(2), PoolOptions{}), core::InternalError);
}

TEST(MesherPool, WaitsForAProcessWhenTheMachineHasNone) {
  const auto pool = start_pool("fork:2:refuse");
  EXPECT_TRUE(pool->mesh(ellipsoids(1), PoolOptions{})[0].ok);
}

TEST(MesherPool, SaysThatTheMachineHasNoProcessAndGoesOnLater) {
  const auto pool = start_pool("fork:6:refuse");
  PoolOptions options;
  options.jobs = 1;
  std::string text;
  try {
    pool->mesh(ellipsoids(1), options);
  } catch (const core::RecoverableError& error) {
    text = error.what();
  }
  EXPECT_NE(text.find("no process for a mesher after several tries: Resource temporarily"),
            std::string::npos)
      << text;
  EXPECT_TRUE(pool->mesh(ellipsoids(1), options)[0].ok);
}

TEST(MesherPool, LeavesNoProcessBehindWhenItEnds) {
  {
    const auto pool = start_pool();
    EXPECT_TRUE(pool->mesh(ellipsoids(1), PoolOptions{})[0].ok);
    EXPECT_EQ(children_of(getpid()).size(), 1U);
  }
  EXPECT_TRUE(children_of(getpid()).empty());
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);  // no zombie either
}

TEST(MesherPool, LeavesNoProcessBehindWhenItsParentIsKilled) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // orphans come to this process
  const pid_t parent = fork();
  if (parent == 0) {
    const auto pool = start_pool("gmsh-hxt:0:hang,gmsh-hxt:25:hang");
    PoolOptions options;
    options.jobs = 2;
    options.meshers = {"gmsh-hxt"};
    pool->mesh(ellipsoids(26), options);  // two batches
    _exit(0);
  }
  std::vector<pid_t> server, children;
  ASSERT_TRUE(eventually([&] {
    server = children_of(parent);
    if (server.size() == 1) children = children_of(server[0]);
    return children.size() == 2;
  }));
  kill(parent, SIGKILL);
  EXPECT_TRUE(eventually([] {  // all have ended, and none is left to reap
    pid_t pid = 0;
    do pid = waitpid(-1, nullptr, WNOHANG);
    while (pid > 0);
    return pid < 0;
  }));
  for (const pid_t pid : {server[0], children[0], children[1]}) EXPECT_NE(kill(pid, 0), 0);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
}

TEST(MesherPool, WorkersHaveNothingOfMpi) {
  setenv("OMPI_COMM_WORLD_RANK", "0", 1);
  setenv("PMIX_RANK", "0", 1);
  const auto pool = start_pool();
  unsetenv("OMPI_COMM_WORLD_RANK");
  unsetenv("PMIX_RANK");
  ASSERT_TRUE(pool->mesh(ellipsoids(1), PoolOptions{})[0].ok);
  const auto servers = children_of(getpid());
  ASSERT_EQ(servers.size(), 1U);
  std::ifstream in("/proc/" + std::to_string(servers[0]) + "/environ", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(text.find("OMP_NUM_THREADS=1"), std::string::npos);
  EXPECT_EQ(text.find("OMPI_"), std::string::npos);
  EXPECT_EQ(text.find("PMIX_"), std::string::npos);
}

}  // namespace
}  // namespace polyslip::mesh
