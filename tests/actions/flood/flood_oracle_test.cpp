// Which floods may answer "no", given what manoeuvres declare and guess.

#include "actions/flood/flood_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/cancellation_token.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

using graph::RouteOracleAnswer;

/// A leap that declares its bounds. It may guess them first.
class DeclaredLeap : public Leap {
 public:
  DeclaredLeap(const PlanningContext& context, ManoeuvreBounds guessed, ManoeuvreBounds known)
      : Leap(context, Refutes, Slides), bounds_(std::move(guessed)), known_(std::move(known)) {}
  ManoeuvreBounds Bounds() const override { return bounds_; }
  bool ReplaceGuesses(const CancellationToken& cancellation) override {
    ++times_asked;
    cancellation.ThrowIfCancelled();
    const bool changes = !known_once_;
    known_once_ = true;
    bounds_ = known_;
    return changes;
  }
  int times_asked = 0;

 private:
  ManoeuvreBounds bounds_;
  ManoeuvreBounds known_;
  bool known_once_ = false;
};

/// Landings where the leap lands (Leap::kHalf), or nowhere. The flight is shorter than a leg.
ManoeuvreBounds Lands(bool across) {
  const double length = 2 * Leap::kHalf;
  const LandingRange range{
      {Eigen::Vector2d(length - 0.1, -0.1), Eigen::Vector2d(length + 0.1, 0.1)}, 0.1};
  return {[=](double) { return across ? std::optional(range) : std::nullopt; },
          FlightBounds{0.1, 0.1}};
}

class FloodOracleTest : public ::testing::Test {
 protected:
  RouteOracleAnswer Ask(const CancellationToken& cancellation = {}) {
    oracle_.emplace(DrcHubo1Locomotion(), (**context_).world, manoeuvres_, 0.1, cancellation);
    return oracle_->Ask({0, {-1.2, 0, 0}, 0}, {{0, {1.2, 0, 0}, 0}});
  }
  std::shared_ptr<DeclaredLeap> AddLeap(const ManoeuvreBounds& guessed,
                                        const ManoeuvreBounds& known) {
    auto leap = std::make_shared<DeclaredLeap>(**context_, guessed, known);
    manoeuvres_.push_back(leap);
    return leap;
  }
  void BuildWall() {
    models::Environment environment = PitScene(true).environment;
    models::Obstacle wall;
    wall.name = "wall";
    wall.shape = models::Shape::Box({0.3, 10, 4});
    environment.obstacles.push_back(wall);
    context_.emplace(environment);
  }

  std::optional<Context> context_{std::in_place, PitScene(false).environment};
  std::vector<std::shared_ptr<Manoeuvre>> manoeuvres_;
  std::optional<FloodOracle> oracle_;
};

TEST_F(FloodOracleTest, AnOpenWayIsAnsweredUnknown) {
  context_.emplace(PitScene(true).environment);
  EXPECT_EQ(Ask(), RouteOracleAnswer::kUnknown);
}

/// Feet need ground. A pelvis within a leg's reach of both floors could cross.
TEST_F(FloodOracleTest, APitIsAnsweredExhaustedNotProvenInfeasible) {
  EXPECT_EQ(Ask(), RouteOracleAnswer::kExhausted);
  EXPECT_EQ(oracle_->barrier().closed_by, std::vector<std::string>{"no ground"});
  EXPECT_LT(oracle_->barrier().closest.x(), 0);
}

TEST_F(FloodOracleTest, AWallAcrossTheBoundsIsAnsweredProvenInfeasible) {
  BuildWall();
  EXPECT_EQ(Ask(), RouteOracleAnswer::kProvenInfeasible);
  EXPECT_EQ(oracle_->barrier().closed_by, std::vector<std::string>{"wall"});
  // The regions of both floods: what walking reached, and what the pelvis reached.
  std::vector<std::string> actions;
  for (const ReachedRegion& region : oracle_->barrier().reached) actions.push_back(region.action);
  std::sort(actions.begin(), actions.end());
  EXPECT_EQ(actions.front(), "");
  EXPECT_EQ(actions.back(), "walk");
}

TEST_F(FloodOracleTest, AManoeuvreThatLandsAcrossIsAnsweredUnknown) {
  AddLeap(Lands(true), Lands(true));
  EXPECT_EQ(Ask(), RouteOracleAnswer::kUnknown);
}

TEST_F(FloodOracleTest, AManoeuvreWithoutBoundsIsAnsweredUnknown) {
  AddLeap({}, {});
  EXPECT_EQ(Ask(), RouteOracleAnswer::kUnknown);
}

/// The flood over C_N is bounded by where a flight could lead, whatever is known of the landings.
TEST_F(FloodOracleTest, AWallIsAnsweredExhaustedIfFlightBoundsAreUnknown) {
  BuildWall();
  ManoeuvreBounds nowhere = Lands(false);
  nowhere.flight.reset();
  AddLeap(nowhere, nowhere);
  EXPECT_EQ(Ask(), RouteOracleAnswer::kExhausted);
}

TEST_F(FloodOracleTest, GuessedBoundsAreReplacedBeforeANo) {
  const auto leap = AddLeap(Lands(false), Lands(true));
  EXPECT_EQ(Ask(), RouteOracleAnswer::kUnknown);
  EXPECT_EQ(leap->times_asked, 1);
}

TEST_F(FloodOracleTest, GuessedBoundsThatHoldAreAnsweredExhausted) {
  const auto leap = AddLeap(Lands(false), Lands(false));
  EXPECT_EQ(Ask(), RouteOracleAnswer::kExhausted);
  EXPECT_EQ(leap->times_asked, 1);
}

TEST_F(FloodOracleTest, GuessedBoundsThatBecomeUnknownAreAnsweredUnknown) {
  AddLeap(Lands(false), {});
  EXPECT_EQ(Ask(), RouteOracleAnswer::kUnknown);
}

/// Time ends within the flood over C_S or while its guesses are replaced. The flood over C_N only
/// adds to a "no".
TEST_F(FloodOracleTest, TheAnswerIsUnknownIfTimeEndsBeforeGuessesAreReplaced) {
  const auto leap = AddLeap(Lands(false), Lands(false));
  int asked = 0, of_guesses = 0;
  EXPECT_EQ(Ask(CancellationToken([&] {
              ++asked;
              if (leap->times_asked == 1 && of_guesses == 0) of_guesses = asked;
              return true;
            })),
            RouteOracleAnswer::kExhausted);
  ASSERT_GT(of_guesses, 100);
  for (const int limit : {0, 1, of_guesses / 2, of_guesses - 1, of_guesses}) {
    asked = 0;
    EXPECT_EQ(Ask(CancellationToken([&] { return ++asked <= limit; })),
              limit == of_guesses ? RouteOracleAnswer::kExhausted : RouteOracleAnswer::kUnknown)
        << limit << " of " << of_guesses;
  }
}

}  // namespace
}  // namespace possibility::actions
