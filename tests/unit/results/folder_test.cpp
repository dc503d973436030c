#include "results/folder.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "results/checkpoint.hpp"

namespace polyslip {
namespace {

namespace fs = std::filesystem;
using tests::fabricated_snapshot;
using tests::spit;

template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(RunFolder, IsMadeWhereThereIsNone) {
  const tests::TemporaryFolder folder;
  results::check_run_folder(folder / "a/b", false);
  EXPECT_TRUE(fs::is_empty(folder.path()));
  results::prepare_run_folder(folder / "a/b", false);
  EXPECT_TRUE(fs::is_directory(folder / "a/b/results"));
  EXPECT_TRUE(fs::is_directory(folder / "a/b/checkpoints"));
  EXPECT_TRUE(results::run_files(folder / "a/b").empty());
}

TEST(RunFolder, AnEarlierRunIsKeptUnlessAsked) {
  const tests::TemporaryFolder folder;
  results::prepare_run_folder(folder.path(), false);
  const std::vector<std::string> ours{"checkpoints/checkpoint-0001.h5",
                                      "deck.resolved.toml",
                                      "figures/means.svg",
                                      "figures/odf-sections-0.3.csv",
                                      "log.txt",
                                      "macro.csv",
                                      "mesh-000.msh",
                                      "polycrystal.png",
                                      "polycrystal.tess",
                                      "report.html",
                                      "results.xdmf",
                                      "results/index.json",
                                      "results/state-0000.h5",
                                      "results/state-0001.h5.part",
                                      "summary.json"};
  const std::vector<std::string> others{"deck.toml",        "notes.txt",
                                        "mesh-mine.msh",    "results/paper.pdf",
                                        "figures/mine.svg", "checkpoints/state-0000.h5"};
  fs::create_directory(folder / "figures");
  for (const auto& name : ours) spit(folder / name, name);
  for (const auto& name : others) spit(folder / name, name);
  EXPECT_EQ(results::run_files(folder.path()), ours);

  const auto error = error_of([&] { results::prepare_run_folder(folder.path(), false); });
  EXPECT_NE(error.find("--overwrite"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos);
  for (const auto& name : ours) EXPECT_EQ(tests::slurp(folder / name), name);

  results::prepare_run_folder(folder.path(), true);
  for (const auto& name : ours) EXPECT_FALSE(fs::exists(folder / name)) << name;
  for (const auto& name : others) EXPECT_EQ(tests::slurp(folder / name), name);
}

TEST(RunFolder, ADeckAloneIsNoRun) {
  const tests::TemporaryFolder folder;
  spit(folder / "deck.toml", "[polycrystal]");
  EXPECT_EQ(error_of([&] { results::check_run_folder(folder.path(), false); }), "");
}

TEST(RunFolder, WhatCannotBeWrittenToIsRefused) {
  const tests::TemporaryFolder folder;
  spit(folder / "file", "");
  for (const std::string& bad : {folder / "file", folder / "file/run", std::string("/proc/run")}) {
    const auto error = error_of([&] { results::check_run_folder(bad, true); });
    EXPECT_NE(error.find(bad.substr(0, 5)), std::string::npos) << bad << ": " << error;
  }
}

TEST(Checkpoints, TheLastTwoAreKept) {
  const tests::TemporaryFolder folder;
  EXPECT_FALSE(results::newest_valid_checkpoint(folder.path()).has_value());
  for (int n = 0; n < 4; ++n)
    results::write_checkpoint(folder.path(), n, fabricated_snapshot(1, 0.1 * n));
  spit(folder / "checkpoints/checkpoint-0004.h5.part", "half");
  const auto newest = results::newest_valid_checkpoint(folder.path());
  ASSERT_TRUE(newest.has_value());
  EXPECT_EQ(newest->number, 3);
  EXPECT_EQ(results::read_checkpoint(newest->path).strain, 0.1 * 3);
  EXPECT_FALSE(fs::exists(folder / "checkpoints/checkpoint-0001.h5"));
  EXPECT_TRUE(fs::exists(folder / "checkpoints/checkpoint-0002.h5"));
  results::write_checkpoint(folder.path(), 4, fabricated_snapshot(1, 0.4));
  EXPECT_FALSE(fs::exists(folder / "checkpoints/checkpoint-0004.h5.part"));
  EXPECT_EQ(results::newest_valid_checkpoint(folder.path())->number, 4);
}

TEST(Checkpoints, ADamagedOneIsNamedWithTheWayOut) {
  const tests::TemporaryFolder folder;
  for (int n = 0; n < 2; ++n)
    results::write_checkpoint(folder.path(), n, fabricated_snapshot(1, 0.1 * n));
  const std::string newest = folder / "checkpoints/checkpoint-0001.h5";
  fs::resize_file(newest, fs::file_size(newest) / 2);
  auto error = error_of([&] { results::newest_valid_checkpoint(folder.path()); });
  EXPECT_NE(error.find("checkpoint-0001.h5: is damaged ("), std::string::npos) << error;
  EXPECT_NE(error.find("delete this file to restart from"), std::string::npos) << error;
  EXPECT_NE(error.find("checkpoint-0000.h5"), std::string::npos) << error;
  fs::remove(newest);
  EXPECT_EQ(results::newest_valid_checkpoint(folder.path())->number, 0);
}

TEST(Checkpoints, OfAnotherDeckAreRefused) {
  auto s = fabricated_snapshot(1, 0.1);
  EXPECT_EQ(error_of([&] { results::require_same_deck(s, "c.h5", "abc"); }), "");
  const auto error = error_of([&] { results::require_same_deck(s, "c.h5", "abd"); });
  EXPECT_NE(error.find("c.h5: checkpoint of another deck"), std::string::npos) << error;
  s.provenance.clear();
  EXPECT_NE(error_of([&] { results::require_same_deck(s, "c.h5", "abc"); }), "");
}

}  // namespace
}  // namespace polyslip
