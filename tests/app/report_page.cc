// The report page: its object reads back, nothing of a user's leaves the object, nothing is
// fetched.
#include <gmock/gmock.h>

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "app/report/page/diagnosis_page.h"
#include "app/report/page/identification_page.h"
#include "app/report/summary.h"
#include "constraints/estimation/identification.h"
#include "io/files/data_set_file.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"
#include "tests/app/cell.h"
#include "tests/shared_data.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kMostBytes = 2'000'000;
constexpr const char* kHostile = "</script><img src=x onerror=document.title='owned'>&\"'";

/// The text of the element with the object.
std::string object_text(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return page.substr(from, page.find("</script>", from) - from);
}

/// Touches and readings of a simulated robot, and what they identify.
class ReportPage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new std::filesystem::path(std::filesystem::temp_directory_path() /
                                        ("selfcal_page_" + std::to_string(::getpid())));
    const Ran ran = run_selfcal("simulate " SELFCAL_SOURCE_DIR
                                "/app/examples/rx90_planes.scenario.yaml --out " +
                                folder_->string());
    ASSERT_EQ(ran.status, 0) << ran.out;
    auto loaded = load_data_set(*folder_);
    ASSERT_TRUE(loaded) << loaded.error().what;
    loaded_ = new LoadedDataSet(*std::move(loaded));
    solution_ = new Solution(identify(*loaded_->robot, loaded_->data));
  }
  static void TearDownTestSuite() {
    std::filesystem::remove_all(*folder_);
    delete solution_;
    delete loaded_;
    delete folder_;
  }

  static PageSubject subject() { return {*loaded_->robot, loaded_->data, "cell", 0}; }
  static nlohmann::json read_back(const nlohmann::ordered_json& data) {
    return nlohmann::json::parse(object_text(page_of(data)));
  }

  static inline std::filesystem::path* folder_ = nullptr;
  static inline LoadedDataSet* loaded_ = nullptr;
  static inline Solution* solution_ = nullptr;
};

TEST_F(ReportPage, HoldsTheNumbersOfTheResultBitByBit) {
  const nlohmann::json data = read_back(identification_data(subject(), *solution_));
  nlohmann::json result = to_json(*solution_, loaded_->robot->name(), model_hash(*loaded_->robot));

  for (const char* part : {"parameters", "uncertainty", "residual", "rejected", "gauge", "verdict"})
    EXPECT_EQ(data["result"][part], result[part]) << part;
  EXPECT_EQ(data["robot"]["model_hash"], model_hash(*loaded_->robot));
  EXPECT_EQ(data["version"], SELFCAL_VERSION);
}

TEST_F(ReportPage, HasARowOfTheTablesForEveryRowWithAnEquation) {
  const nlohmann::json rows = read_back(identification_data(subject(), *solution_))["rows"];

  ASSERT_EQ(rows["of"], solution_->residual.rows.size());
  double squares = 0, judged = 0;
  for (std::size_t i = 0; i < rows["row"].size(); ++i) {
    if (rows["check"][i] == 0) continue;
    squares += std::pow(rows["after"][i].get<double>(), 2);
    ++judged;
  }
  EXPECT_EQ(judged, solution_->residual.check.rows);
  // Five digits of each row.
  EXPECT_NEAR(std::sqrt(squares / judged), solution_->residual.check.rms_after,
              1e-4 * solution_->residual.check.rms_after);
}

TEST_F(ReportPage, LeadsFromAPlaneTouchToThePlaneByTheResidual) {
  for (const RowFigure& row : solution_->residual.rows) {
    EXPECT_NEAR(row.way_after.norm(), row.after, 1e-12);  // rounding, of metres
    EXPECT_NEAR(row.way_before.norm(), row.before, 1e-12);
  }
  // All of one plane lie along its normal.
  const RowFigure &one = solution_->residual.rows[0], &other = solution_->residual.rows[1];
  ASSERT_EQ(one.set, other.set);
  EXPECT_NEAR(one.way_after.normalized().cross(other.way_after.normalized()).norm(), 0, 1e-6);
}

TEST_F(ReportPage, StaysBelowTwoMegabytesWithManyRows) {
  Solution many = *solution_;
  while (many.residual.rows.size() < 20000)
    many.residual.rows.insert(many.residual.rows.end(), solution_->residual.rows.begin(),
                              solution_->residual.rows.end());
  const nlohmann::ordered_json data = identification_data(subject(), many);

  EXPECT_LT(page_of(data).size(), kMostBytes);
  EXPECT_EQ(data["rows"]["of"], many.residual.rows.size());
  EXPECT_LE(data["rows"]["row"].size(), 2000);
}

TEST_F(ReportPage, FetchesNothing) {
  const std::string page = page_of(identification_data(subject(), *solution_));

  EXPECT_FALSE(std::regex_search(page.substr(0, 20000), std::regex("<link|<img|<iframe| src=")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST_F(ReportPage, KeepsHostileNamesInsideItsObject) {
  PageSubject hostile = subject();
  hostile.name = kHostile;
  nlohmann::ordered_json data = identification_data(hostile, *solution_);
  data["robot"]["name"] = kHostile;
  data["verdict"]["why"] = std::string("\xff<!--<script>");  // no UTF-8, and what opens a comment
  const std::string page = page_of(data);

  EXPECT_THAT(object_text(page), Not(HasSubstr("<")));
  const nlohmann::json back = nlohmann::json::parse(object_text(page));
  EXPECT_EQ(back["robot"]["name"], kHostile);
  EXPECT_EQ(back["data"]["name"], kHostile);
}

TEST_F(ReportPage, LeavesOutWhatTheResultLacks) {
  Solution bare;
  bare.verdict.why = "no rows to identify from";
  const nlohmann::json data = read_back(identification_data(subject(), bare));

  EXPECT_FALSE(data.contains("rows"));
  EXPECT_FALSE(data.contains("picture"));
  EXPECT_TRUE(data["result"]["uncertainty"].is_null());
  EXPECT_FALSE(read_back(identification_data(subject(), *solution_))["rows"].contains("load"));
}

TEST_F(ReportPage, TellsInOneSentenceWhatFalseRowsHide) {
  Solution solution;
  solution.verdict.answer = Answer::improved;
  solution.residual.check.rows = 12;
  solution.residual.check.rms_before = 2e-3;
  solution.residual.check.rms_after = 1e-3;
  solution.residual.check.rows_without_outliers = 11;
  solution.residual.check.rms_without_outliers = 2.5e-5;
  solution.residual.check.rms_before_without_outliers = 1e-3;
  EXPECT_EQ(headline(solution),
            "Improved: the tool is met to 0.025 mm instead of 1 mm on 11 rows kept aside; with 1 "
            "beyond the noise 1 mm instead of 2 mm.");

  solution.residual.check.rows_without_outliers = 0;  // all of them are
  solution.residual.check.rms_without_outliers = 0;
  EXPECT_EQ(headline(solution),
            "Improved: the tool is met to 1 mm instead of 2 mm on 12 rows kept aside.");
}

/// What a headless Chromium has drawn, as HTML; its messages go to `messages`.
std::string drawn(const std::filesystem::path& page, std::string& messages) {
  const std::string log = page.string() + ".log", out = page.string() + ".dom";
  const std::string command =
      "timeout 60 chromium --headless=new --no-sandbox --disable-gpu --enable-unsafe-swiftshader "
      "--enable-logging=stderr --virtual-time-budget=3000 --user-data-dir=" +
      page.string() + ".profile --dump-dom 'file://" + page.string() + "' >'" + out + "' 2>'" +
      log + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  messages = read_file(log, 64 << 20).value_or("");
  return read_file(out, 64 << 20).value_or("");
}

TEST_F(ReportPage, DrawsItselfInABrowserWithoutErrors) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) {
    ASSERT_FALSE(all_required()) << "SELFCAL_REQUIRE_ALL is set and chromium is not installed";
    GTEST_SKIP() << "chromium is not installed";
  }
  PageSubject hostile = subject();
  hostile.name = kHostile;
  const std::filesystem::path path = *folder_ / "page.html";
  ASSERT_TRUE(write_file_atomically(path, page_of(identification_data(hostile, *solution_))));

  std::string messages;
  const std::string dom = drawn(path, messages);

  EXPECT_THAT(messages, Not(HasSubstr("Uncaught")));
  EXPECT_THAT(messages, Not(HasSubstr("Content Security Policy")));
  for (const char* part : {"Before and after", "In the workspace", "What moved", "How sure",
                           "Residuals row by row", "Rows beyond the noise"})
    EXPECT_THAT(dom, HasSubstr("<h2>" + std::string(part) + "</h2>"));
  EXPECT_THAT(dom, HasSubstr("<title>Calibration of " + loaded_->robot->name()));
  EXPECT_THAT(dom, Not(HasSubstr("<img")));
  EXPECT_THAT(dom, Not(HasSubstr("<title>owned")));
}

}  // namespace
}  // namespace selfcal
