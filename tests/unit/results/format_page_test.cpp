#include "results/format_page.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.hpp"
#include "fabricated.hpp"
#include "results/schema.hpp"

namespace polyslip {
namespace {

TEST(FormatPage, IsTheOneInDocs) {
  const std::string path = std::string(POLYSLIP_SOURCE_DIR) + "/docs/results-format.md";
  const std::string page = results::results_format_page();
  if (std::getenv("POLYSLIP_UPDATE_DOCS") != nullptr) tests::spit(path, page);
  EXPECT_GT(page.size(), 3000u);
  EXPECT_EQ(tests::slurp(path), page) << "stale: run this test with POLYSLIP_UPDATE_DOCS=1";
}

TEST(Schema, EveryDatasetHasItsSentence) {
  for (const auto& spec : results::state_schema()) {
    EXPECT_FALSE(spec.description.empty()) << spec.name;
    EXPECT_FALSE(spec.location.empty()) << spec.name;
    EXPECT_EQ(&results::dataset_spec(spec.name), &spec) << "named twice: " << spec.name;
  }
  EXPECT_EQ(results::dataset_spec("state/point/slip").name, "state/point/*");
  EXPECT_THROW(results::dataset_spec("state/point/a/b"), core::InternalError);
  EXPECT_THROW(results::dataset_spec("elements/speed"), core::InternalError);
}

TEST(Schema, ReaderRefusesWhatIsNotInTheTable) {
  const tests::TemporaryFolder folder;
  {
    auto file = results::hdf5::File::create(folder / "a.h5", 512);
    const std::vector<std::uint64_t> three{3}, four{4};
    const std::vector<double> values(4, 1.0);
    file.write("elements/g", results::hdf5::Number::float64, three, values.data());
    file.write("elements/slip", results::hdf5::Number::float64, four, values.data());
    file.write("elements/pressure", results::hdf5::Number::float64, {}, values.data());
    const std::vector<std::int32_t> ints(3, 1);
    file.write("elements/volume", results::hdf5::Number::int32, three, ints.data());
    file.close();
  }
  const auto file = results::hdf5::File::open(folder / "a.h5");
  results::TableReader reader(file);
  EXPECT_EQ(reader.get<double>("elements/g").size(), 3u);
  EXPECT_THROW(reader.get<double>("elements/slip"), core::InputError);               // not three
  EXPECT_THROW(reader.get<double>("elements/pressure"), core::InputError);           // no list
  EXPECT_THROW(reader.get<double>("elements/volume"), core::InputError);             // other type
  EXPECT_THROW(reader.get<double>("elements/equivalent_strain"), core::InputError);  // not there
}

}  // namespace
}  // namespace polyslip
