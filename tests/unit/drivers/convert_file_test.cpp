#include "drivers/convert_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"
#include "drivers/mesh_files.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/tess_reader.hpp"
#include "support/box_mesh.hpp"

namespace polyslip::drivers {
namespace {

namespace fs = std::filesystem;

class ConvertFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + fmt::format("polyslip_convert_file_{}/", ::getpid());
    core::make_folder(folder_);
    fs::copy_file(POLYSLIP_SOURCE_DIR "/tests/data/n20-id1-raw.tess", folder_ + "a.tess");
    mesh::Mesh mesh = tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2);
    for (auto& x : mesh.nodes) x = 3 * x + core::Vec3(1, -2, 0.5);
    mesh::write_msh(mesh, folder_ + "b.msh");
    core::write_file(folder_ + "b.msh",
                     core::read_text(folder_ + "b.msh") +
                         "$ElsetOrientations\n2 rodrigues:passive\n1 0.1 0.2 0.3\n2 0 0 0.2\n"
                         "$EndElsetOrientations\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string convert(const std::string& in, const std::string& out, const std::string& format = "",
                      bool overwrite = false) {
    return convert_file(folder_ + in, folder_ + out, format, overwrite);
  }
  std::string error_of(const std::string& in, const std::string& out,
                       const std::string& format = "") {
    try {
      convert(in, out, format);
    } catch (const core::InputError& e) {
      std::string message = e.what();
      for (std::size_t at; (at = message.find(folder_)) != std::string::npos;)
        message.erase(at, folder_.size());
      return message;
    }
    return "no error";
  }

  std::string folder_;
};

TEST_F(ConvertFile, MeshesKeepTheirPlaceAndOrientationsThroughEveryFormat) {
  convert("b.msh", "c.msh", "msh4-binary");
  convert("c.msh", "d.msh", "msh-binary");
  convert("d.msh", "e.msh", "msh4");
  convert("e.msh", "f.msh");
  const auto before = mesh::read_msh(folder_ + "b.msh", mesh::LengthUnit::file);
  const auto after = mesh::read_msh(folder_ + "f.msh", mesh::LengthUnit::file);
  EXPECT_LT((after.origin - core::Vec3(1, -2, 0.5)).norm(), 1e-14);
  ASSERT_EQ(after.mesh.nodes.size(), before.mesh.nodes.size());
  for (std::size_t n = 0; n < before.mesh.nodes.size(); ++n)
    EXPECT_LT((after.mesh.nodes[n] - before.mesh.nodes[n]).norm(), 1e-13);
  EXPECT_EQ(after.mesh.tetrahedra, before.mesh.tetrahedra);
  ASSERT_TRUE(after.orientations);
  for (std::size_t c = 0; c < 2; ++c)
    EXPECT_LT((after.orientations->at(c).coeffs() - before.orientations->at(c).coeffs()).norm(),
              1e-14);
}

TEST_F(ConvertFile, AMeshOfStraightGrainsIsATessellation) {
  convert("b.msh", "b.tess");
  const auto read = mesh::read_tess(folder_ + "b.tess", mesh::LengthUnit::file);
  EXPECT_EQ(read.tessellation.topology.cell_count(), 2);
  EXPECT_EQ(read.tessellation.topology.faces.size(), 11U);
  EXPECT_LT((read.origin - core::Vec3(1, -2, 0.5)).norm(), 1e-14);
  EXPECT_NEAR(mesh::cell_volume(read.tessellation, 0), 27, 1e-11);
  EXPECT_TRUE(read.orientations);
}

TEST_F(ConvertFile, TessellationsGoToTessellationsAndPictures) {
  EXPECT_EQ(convert("a.tess", "c.tess"), folder_ + "c.tess: 20 cells, 127 faces (tess)");
  const auto a = mesh::read_tess(folder_ + "a.tess"), c = mesh::read_tess(folder_ + "c.tess");
  EXPECT_EQ(a.tessellation.vertices, c.tessellation.vertices);
  convert("a.tess", "c.vtu");
  EXPECT_GT(fs::file_size(folder_ + "c.vtu"), 5000U);
  convert("b.msh", "c.inp");
  EXPECT_GT(fs::file_size(folder_ + "c.inp"), 5000U);
}

TEST_F(ConvertFile, SaysWhatDoesNotGo) {
  EXPECT_EQ(error_of("none.tess", "c.vtu"), "none.tess: no such file");
  EXPECT_EQ(error_of("a.tess", "b.msh"),
            "b.msh: is there; give another name, or replace it with --overwrite");
  EXPECT_EQ(error_of("a.tess", "c.msh").substr(0, 50),
            "a.tess: a tessellation has no mesh to write as msh");
  EXPECT_EQ(error_of("a.tess", "c.stl"),
            "c.stl: its extension tells no format; name one of msh, msh-binary, msh4, msh4-binary, "
            "vtu, inp, tess with --format");
  EXPECT_EQ(error_of("a.tess", "c.vtu", "vtk"),
            "--format vtk: must be one of msh, msh-binary, msh4, msh4-binary, vtu, inp, tess");
  core::write_file(folder_ + "x.txt", "");
  EXPECT_EQ(error_of("x.txt", "c.vtu"),
            "x.txt: must be a tessellation (.tess) or a mesh (.msh); .gz too");
  EXPECT_FALSE(fs::exists(folder_ + "c.vtu"));
}

TEST_F(ConvertFile, ARunFolderGetsTheFilesThatTheDeckNames) {
  const mesh::Mesh mesh = tests::box_mesh({4, 2, 2}, {2, 1, 1}, 2);
  write_mesh_files(mesh, folder_, 3, {"msh4", "vtu", "inp"});
  for (const char* name : {"mesh-003.msh", "mesh-003.vtu", "mesh-003.inp"})
    EXPECT_TRUE(fs::exists(folder_ + name)) << name;
  EXPECT_EQ(mesh::read_msh(folder_ + "mesh-003.msh").mesh.nodes, mesh.nodes);
}

}  // namespace
}  // namespace polyslip::drivers
