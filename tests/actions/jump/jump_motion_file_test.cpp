#include "actions/jump/jump_motion_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "actions/jump/jump_library.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

namespace fs = std::filesystem;

const JumpTask kHalfMetre = {0.5, 0};

NominalStance StanceOf(const std::string& gait) {
  return SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed(gait));
}

fs::path ShippedLibrary() { return DrcHubo1().file.parent_path() / "jumps"; }

class JumpMotionFileTest : public ::testing::Test {
 protected:
  JumpMotionFileTest()
      : walk_(StanceOf("walk")),
        crawl_(StanceOf("crawl")),
        solver_(DrcHubo1(), walk_, crawl_),
        folder_(fs::temp_directory_path() /
                (std::string("possibility_jump_motion_") +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        file_(folder_ / "jump.zip") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~JumpMotionFileTest() override { fs::remove_all(folder_); }

  /// The solution's file of a shipped jump.
  fs::path ShippedSolution() const {
    return JumpLibrary(solver_, ShippedLibrary()).folder() / "jump_10_0.json";
  }

  /// The answer of a library in this test's folder that has the solution alone.
  JumpAnswer RealisedAnswer() const {
    JumpLibrary library(solver_, folder_);
    fs::create_directories(library.folder());
    fs::copy_file(ShippedSolution(), library.folder() / "jump_10_0.json");
    return library.Find(kHalfMetre).value();
  }

  SolvedJump Realised() const { return *RealisedAnswer().jump; }

  NominalStance walk_;
  NominalStance crawl_;
  JumpSolver solver_;
  fs::path folder_;
  fs::path file_;
};

TEST_F(JumpMotionFileTest, ReadsBackFarMoreFinelyThanPlansAreRounded) {
  const SolvedJump jump = Realised();
  WriteJumpMotion(jump, DrcHubo1(), file_);
  const SolvedJump read = ReadJumpMotion(kHalfMetre, DrcHubo1(), file_);
  EXPECT_GT(read.preparation, 0);
  EXPECT_NEAR(read.preparation, jump.preparation, 1e-12);
  ASSERT_EQ(read.phases.size(), jump.phases.size());
  for (std::size_t i = 0; i < jump.phases.size(); ++i) {
    const Phase& before = jump.phases[i];
    const Phase& after = read.phases[i];
    EXPECT_EQ(after.contacts, before.contacts);
    EXPECT_EQ(after.acceleration_bits, before.acceleration_bits);
    ASSERT_EQ(after.impulses.cols(), before.impulses.cols());
    EXPECT_LT((after.impulses - before.impulses).norm(), 1e-4);
    ASSERT_EQ(after.knots.size(), before.knots.size());
    for (std::size_t k = 0; k < before.knots.size(); ++k) {
      const Knot& a = before.knots[k];
      const Knot& b = after.knots[k];
      EXPECT_NEAR(b.t, a.t, 1e-10);
      EXPECT_NEAR(std::abs(b.q.head<4>().dot(a.q.head<4>())), 1, 1e-12);
      EXPECT_LT((b.q - a.q).tail(a.q.size() - 4).lpNorm<Eigen::Infinity>(), 1e-9);
      EXPECT_LT((b.v - a.v).lpNorm<Eigen::Infinity>(), 1e-7);
      EXPECT_LT((b.a - a.a).lpNorm<Eigen::Infinity>(), 1e-6);
      EXPECT_LT((b.tau - a.tau).lpNorm<Eigen::Infinity>(), 1e-6);
      ASSERT_EQ(b.forces.cols(), a.forces.cols());
      if (a.forces.cols() > 0) {
        EXPECT_LT((b.forces - a.forces).lpNorm<Eigen::Infinity>(), 1e-6);
      }
    }
  }
}

TEST_F(JumpMotionFileTest, AJumpWithoutPreparationHasNone) {
  SolvedJump jump = Realised();
  jump.phases.erase(jump.phases.begin());
  jump.preparation = 0;
  WriteJumpMotion(jump, DrcHubo1(), file_);
  const SolvedJump read = ReadJumpMotion(kHalfMetre, DrcHubo1(), file_);
  EXPECT_EQ(read.preparation, 0);
  EXPECT_EQ(read.phases.size(), jump.phases.size());
}

TEST_F(JumpMotionFileTest, RefusesMotionOfAnotherRobot) {
  WriteJumpMotion(Realised(), DrcHubo1(), file_);
  models::RobotModel other = DrcHubo1();
  other.joints.front().name = "another";
  EXPECT_THROW(ReadJumpMotion(kHalfMetre, other, file_), InputError);
  other = DrcHubo1();
  other.contacts.front().points.pop_back();
  EXPECT_THROW(ReadJumpMotion(kHalfMetre, other, file_), InputError);
}

TEST_F(JumpMotionFileTest, LibrariesRealiseASolutionWithoutMotion) {
  const JumpAnswer answer = RealisedAnswer();
  const JumpLibrary library(solver_, folder_);
  EXPECT_TRUE(answer.solution);
  EXPECT_TRUE(answer.jump->report);
  library.Save(answer, kHalfMetre);
  EXPECT_TRUE(fs::exists(library.folder() / "jump_10_0.zip"));

  const JumpAnswer stored = JumpLibrary(solver_, folder_).Find(kHalfMetre).value();
  EXPECT_FALSE(stored.solution);
  EXPECT_FALSE(stored.jump->report);
  EXPECT_NEAR(stored.jump->duration(), answer.jump->duration(), 1e-9);
}

TEST_F(JumpMotionFileTest, LibrariesRealiseASolutionWhoseMotionIsSpoilt) {
  const JumpLibrary library(solver_, folder_);
  library.Save(RealisedAnswer(), kHalfMetre);
  const fs::path motion = library.folder() / "jump_10_0.zip";
  const std::string bytes = models::ReadFileContents(motion);
  std::ofstream(motion, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  const JumpAnswer answer = JumpLibrary(solver_, folder_).Find(kHalfMetre).value();
  EXPECT_TRUE(answer.solution);
}

/// What `possibility library` stored is what the solution gives.
TEST_F(JumpMotionFileTest, ShippedMotionsAreThoseOfTheirSolutions) {
  const SolvedJump realised = Realised();
  const JumpAnswer shipped = JumpLibrary(solver_, ShippedLibrary()).Find(kHalfMetre).value();
  EXPECT_FALSE(shipped.solution);
  ASSERT_EQ(shipped.jump->phases.size(), realised.phases.size());
  for (std::size_t i = 0; i < realised.phases.size(); ++i) {
    const std::vector<Knot>& a = realised.phases[i].knots;
    const std::vector<Knot>& b = shipped.jump->phases[i].knots;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_LT((b[k].q - a[k].q).tail(a[k].q.size() - 4).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace possibility::actions
