// The recipes of examples/graphs/.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>

#include "cli/recipe.h"

namespace cambium {
namespace {

std::filesystem::path reference() { return std::filesystem::path(CAMBIUM_SOURCE) / "examples/graphs/reference.tree.toml"; }

/// Under the graph's own name for it: keys of roots are the graph's, those of other solids the volume's.
std::string plain_key(std::string key) {
  for (const auto& [begin, instead] : {std::pair{"roots.", ""}, {"level.shape.", "volume."}})
    if (key.starts_with(begin)) key = instead + key.substr(std::string(begin).size());
  return key;
}

/// Keys by whether some line that names them ends with a comment. Lines that are commented out count.
std::map<std::string, bool> keys_in_reference() {
  const std::regex header(R"(^#?\[+skeleton\.graph\.?([\w.]*)\]+.*)"), other_header(R"(^#?\[.*)"), setting(R"(^#?(\w+) = (.*))"), inner(R"((\w+) =)");
  std::map<std::string, bool> keys;
  std::string table;
  bool in_graph = false;
  std::ifstream file(reference());
  std::smatch match;
  for (std::string line; std::getline(file, line);) {
    if (std::regex_match(line, match, header)) {
      in_graph = true;
      table = match[1].length() ? match[1].str() + "." : "";
      if (match[1].length()) keys[plain_key(match[1])] |= line.find(" # ") != std::string::npos;
    } else if (std::regex_match(line, match, other_header)) {
      in_graph = false;
    } else if (in_graph && std::regex_match(line, match, setting)) {
      const bool commented = line.find(" # ") != std::string::npos;
      const std::string key = table + match[1].str(), value = match[2];
      keys[plain_key(key)] |= commented;
      if (!value.starts_with("{")) continue;
      for (std::sregex_iterator i(value.begin(), value.end(), inner), end; i != end; ++i) keys[plain_key(key + "." + (*i)[1].str())] |= commented;
    }
  }
  return keys;
}

TEST(GraphExamples, TheReferenceNamesEveryKeyWithAComment) {
  const std::set<std::string> known = graph_recipe_keys();
  EXPECT_GT(known.size(), 60u);
  const auto named = keys_in_reference();
  for (const std::string& key : known) {
    const auto found = named.find(key);
    EXPECT_TRUE(found != named.end()) << key << " is not in " << reference();
    // Of what is a table, its keys say what they are.
    const bool has_keys = known.lower_bound(key + ".") != known.end() && known.lower_bound(key + ".")->starts_with(key + ".");
    EXPECT_TRUE(has_keys || found == named.end() || found->second) << key << " has no comment";
  }
  for (const auto& [key, commented] : named) {
    const bool of_solid = key.starts_with("obstacle.") && known.contains("volume." + key.substr(9));
    EXPECT_TRUE(known.contains(key) || of_solid) << key << " is no key";
  }
}

/// The fifteen of the paper's table among them.
TEST(GraphExamples, AllExamplesAreReadWithTheirFilesAndBeginWithTheirSource) {
  std::size_t examples = 0, of_table = 0;
  for (const auto& entry : std::filesystem::directory_iterator(reference().parent_path())) {
    if (!entry.path().string().ends_with(".tree.toml")) continue;
    SCOPED_TRACE(entry.path());
    ++examples;
    of_table += entry.path().filename().string().starts_with("table_2");
    const Recipe recipe = read_recipe(entry.path(), {});
    ASSERT_TRUE(recipe.skeleton.graph);
    EXPECT_TRUE(recipe.mesh.polygonize.tolerance);
    EXPECT_GE(load_graph(*recipe.skeleton.graph).volume.size(), 1u);
    std::ifstream file(entry.path());
    std::string first;
    std::getline(file, first);
    EXPECT_TRUE(first.starts_with("# ")) << first;
  }
  EXPECT_EQ(of_table, 15u);
  EXPECT_GT(examples, 30u);
}

TEST(GraphExamples, TheReferenceIsRead) {
  const Recipe recipe = read_recipe(reference(), {});
  ASSERT_TRUE(recipe.skeleton.graph);
  EXPECT_EQ(recipe.skeleton.graph->levels.size(), 4u);
  EXPECT_EQ(recipe.skeleton.graph->roots.size(), 1u);
}

}  // namespace
}  // namespace cambium
