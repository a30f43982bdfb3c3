// What a diagnosis takes for granted, in one place: each with its range and where it comes from.
//
// Sources: [exact] follows from a formula; [physics] from what machines are like; [habit] a usual
// threshold; [cost] what a small computer can bear; [trials] a judgement, with which the rates hold
// that tests/gap asks of the open trials. What a user may ask for otherwise is in DiagnosisOptions
// and SearchRule; what only keeps rounding out stands beside the algorithm.
#pragma once

#include <array>
#include <cstddef>

#include "diagnosis/constants_report.h"

namespace selfcal {

struct DiagnosisConstants {
  struct Rows {
    int passes = 4;  ///< of search and noise; 2 to 10 [cost]
    /// Equations beyond the geometry; 5 to 30 [habit]
    double fewest_freedoms = 10;
    /// Equations that choose among causes: the evidence of structure takes their third power; 300
    /// to 3000 [cost]
    double most_weighed = 720;
    /// Probability that noise stays below; 1 - 1e-3 to 1 - 1e-7 [habit]
    double far = 1 - 1e-5;
    int fewest_offered = 4;           ///< rows put aside, that are offered back; 3 to 10 [habit]
    double hardly_any = 0.3;          ///< of them; 0.1 to 0.5 [habit]
    double median_to_sigma = 1.4826;  ///< of a normal variable [exact]
    int most_of_configuration = 12;   ///< rows that are weighed; 5 to 50 [cost]
    double fewest_visits = 6;         ///< freedoms that tell a visit's noise; 4 to 20 [habit]
    double most_of_visits = 10;       ///< over the noise of immediate repeats; 3 to 100 [physics]
    /// Of the equations, that unknowns take at most where noise is told from the middle of what is
    /// left; 0.5 to 0.9 [habit]
    double most_taken = 0.7;
    /// Equations beyond the geometry from which a set has a noise of its own; 15 to 60 [habit]
    double fewest_of_set = 20;
    /// Sigmas by which two noises differ once the causes are known; 2 to 5 [habit]
    double unlike = 3;
  };
  /// Structure of no known cause; sizes are over the noise.
  struct Structure {
    struct Shared {
      double kappa, probability;
    };
    /// What a configuration brings along: a surface's roughness and the robot's own repeatability
    /// are noise to a calibration, and hardly ever more than the rest; 0 to 1 [trials]
    std::array<Shared, 4> shared = {{{0, 0.4}, {0.4, 0.3}, {0.7, 0.2}, {0.9, 0.1}}};
    double usual = 0.4;                            ///< of that, beside structure; 0 to 0.9 [trials]
    std::array<double, 3> more = {1.4, 2.8, 5.6};  ///< that is structure; above 1 [trials]
    std::array<double, 5> smooth = {0.35, 0.7, 1.4, 2.8, 5.6};  ///< 0.1 to 10 [trials]
    /// Of errors of one joint; 0.1 to 10 [trials]
    std::array<double, 4> of_joint = {0.7, 1.4, 2.8, 5.6};
    double joints = 1.0;    ///< rad, over which configurations are alike; 0.3 to 2 [trials]
    double turned = 2.0;    ///< rad, over which one joint's errors are smooth; 0.5 to 3 [physics]
    double kinked = 1.0;    ///< the same of those that have steps and kinks; 0.3 to 3 [physics]
    double periodic = 0.5;  ///< of those that are the same a turn later; 0.3 to 1 [physics]
    double place = 0.2;     ///< of the robot's size; 0.1 to 1 [physics]
    double time = 0.06;     ///< of the whole; 0.02 to 0.5 [trials]
    std::array<double, 3> of_visits = {1, 0.5, 0};  ///< shares of a visit's noise [trials]
  };
  struct Evidence {
    double right_sign = 0.99;  ///< prior, of the sign that physics allows; 0.9 to 1 [physics]
    /// Share beyond the nuisance parameters below which a candidate says nothing; 1e-6 to 0.02
    /// [habit]
    double least_seen = 1e-3;
    /// Of a cause, over the noise, each as probable as the others but for the last; 0.1 to 100
    /// [trials]
    std::array<double, 8> sizes = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0};
    /// Probability of the last of these: an instrument that was pushed, a tool that was exchanged;
    /// 0.005 to 0.1 [physics]
    double huge = 0.02;
    /// Times the usual largest: up to it a size is as good as any; 1 to 10 [physics]
    double as_usual = 3;
    double tenfold = 2;      ///< log evidence that ten times that costs; 1 to 5 [trials]
    int agreements = 3;      ///< rounds of noise and structure; 1 to 10 [cost]
    double worthwhile = 5;   ///< log evidence that a cause must bring; 2 to 10 [habit]
    int most_together = 12;  ///< candidates of a set; 3 to 12 [cost]
    int exchanged = 3;  ///< causes tried in the place of either of the best pair; 0 to 6 [cost]
    /// Log weight below the best, that a set has to count at all; and what one costs that needs of
    /// a machine what none has (ReportConstants::impossible, other_sign); 6 to 20, 10 to 50
    /// [physics]
    double counts = 12, impossible = 20;
    std::size_t most_families = 5;  ///< that a set of causes grows to; 3 to 10 [trials]
    /// Log weight below the best, that a coarse search leaves out; 15 to 40 [exact]
    double hopeless = 25;
    double hardly_possible = 40;  ///< the same, that nobody is told of; 20 to 100 [exact]
  };
  /// Of candidates.
  struct Shapes {
    int moments = 24;  ///< at which a step may have happened; 8 to 100 [cost]
    /// Rows, of a cause that steps away and back; 2 to 6 [physics]
    std::size_t fewest_between = 3;
    int few_times = 40;  ///< up to which it may have between any two; 10 to 100 [cost]
    /// Over the usual time from one row to the next, the longest of which a step may lie in; 3 to
    /// 20, 0 to 10 [cost]
    double pause = 5;
    std::size_t most_pauses = 4;
    double plain = 10;        ///< log evidence of a step, tried at more moments; 5 to 30 [cost]
    double likely = 1e-6;     ///< probability from which a step is tried at more; 0 to 0.1 [cost]
    double fewest_times = 8;  ///< below which none is looked for; 4 to 20 [habit]
    int most_waves = 64;      ///< a turn; 10 to 200 [physics]
    int profile = 30;         ///< waves a turn, of a profile; 10 to most_waves [cost]
    /// Waves a turn that rows may hint at: twice a generator's turn in gears of up to 175 to 1;
    /// how likely each is beside the others, and by chance in one joint; so many of a joint; 200 to
    /// 500, 0.01 to 0.2, 0.001 to 0.1, 1 to 6 [physics]
    int most_fine_waves = 350;
    double fine_share = 0.05, fine_by_chance = 0.01;
    std::size_t most_hinted = 4;
    double warms = 0.2;  ///< K; 0.05 to 2 [physics]
    /// Doubt of masses that are usual ones, over their torques; 0.25 to 1 [physics]
    double assumed = 0.6;
    /// Probability that what drifts with the rows' order drifts with time, where they carry none
    /// and may lie in their order by place; 0.3 to 0.9 [physics]
    double order_as_time = 0.5;
    int fewest_rows = 8;  ///< of a surface that is to show its form or shift; 4 to 30 [habit]
    /// kg/m^2, of an arm's mass over the square of its reach, where no mass is known; 20 to 150
    /// [physics]
    double mass_per_reach = 60;
    /// What that is off by at most, as a rule, a factor; and what a compliance is where a known
    /// mass is spread in the usual way; 1.2 to 3 [physics]
    double mass_off = 2.5, spread_off = 1.7;
    double payload = 0.1;  ///< over that mass; 0.02 to 0.3 [physics]
  };
  struct Naming {
    /// From which a cause, or structure of no known one, is taken to be there; 0.5 to 0.7 [exact]
    double probable = 0.5;
    double least_told = 0.005;  ///< probability; 0 to 0.05 [habit]
    /// Of the cause's own: others as probable share its evidence; 0.01 to 0.3 [habit]
    double confounded = 0.05;
    double sure = 0.9;  ///< it stands beside structure of no known one; 0.7 to 0.99 [habit]
    /// What the presence of structure that no listed cause explains takes of the probability of
    /// those that are: of what 0.9 and more was said beside it, half was there; 0.2 to 0.7 [trials]
    double beside_unknown = 0.4;
    /// Of causes that nothing speaks against, those that are another one, which the list lacks and
    /// which looks the same, seen as large as the noise; and at most, of what is hardly seen; 0.02
    /// to 0.15, 0.1 to 0.4 [trials]
    double imitated = 0.05, mostly_imitated = 0.25;
    /// Of the gap, that what is named leaves: structure beside it is as little a doubt, in
    /// proportion, as it leaves less; 0.02 to 0.2 [habit]
    double hardly_left = 0.1;
    /// Share of the gap below which one of several causes closes nothing: beside the others, and
    /// alone; 0 to 0.05 [habit]
    double nothing_beside = 0.005, nothing_alone = 0.02;
    /// Of causes that step again and again at one place, those that did; 0.3 to 0.9 [trials]
    double steps_again = 0.5;
    double settles =
        0.1;  ///< of the session: steps so near each other are one; 0.02 to 0.2 [habit]
    /// Of the gap, that a cause as probable closes more and so leads; 0.05 to 0.3 [habit]
    double plainly_larger = 0.15;
    double as_probable = 0.05;   ///< of probability: causes so near are alike; 0.01 to 0.1 [habit]
    double worth_telling = 0.1;  ///< probability from which look-alikes are; 0 to 0.5 [habit]
    /// Of the squares beyond noise, that what is found may leave: the larger part leads; 0.2 to 0.8
    /// [habit]
    double most_left = 0.5;
    double plainly_left = 2;  ///< of the noise, that rows which no choice saw are left by; 1.5 to 3
                              ///< [trials]
    double of_moment =
        0.95;  ///< probability of the rows that a step is told between; 0.9 to 0.99 [habit]
    std::size_t most_explaining = 20;  ///< candidates; 5 to 60 [cost]
    double surely_unknown = 0.7;       ///< probability; 0.5 to 0.95 [trials]
    double also_there = 0.5;           ///< of the cause's own: further places; 0.2 to 0.9 [trials]
    /// Of a row's noise beyond the geometry, that is scaled up; 0.01 to 0.3 [habit]
    double least_of_row = 0.05;
    double of_tail = 0.2;             ///< share of the resamples that is it; 0.05 to 0.3 [habit]
    std::size_t fewest_of_tail = 15;  ///< resamples; 10 to 50 [habit]
    /// How often noise shows as much structure, from which none of it is believed; 0.1 to 0.5
    /// [habit]
    double no_structure = 0.3;
    double least_p = 1e-6;  ///< that a tail is believed; 1e-9 to 1e-4 [habit]
  };
  /// Sessions that are simulated over the rows.
  struct Simulation {
    double with_none = 0.25, with_unknown = 0.15;  ///< shares of them; 0 to 0.5 [trials]
    int at_once = 10;  ///< sessions whose statistics are held; 1 to 100 [cost]
    /// Such a session has one cause: few pairs are as probable; 0 to 14 [cost]
    int extended_singles = 4;
    std::array<double, 3> visible = {0.5, 1.0, 2.0};  ///< over the noise; 0.25 to 4 [trials]
    /// Share beyond the nuisance parameters below which calibration absorbs a cause; 0.02 to 0.3
    /// [trials]
    double least_beyond_nuisance = 0.15;
    /// Temperatures that may calibrate probabilities, and from one to the next; 0.5 to 1, 2 to 10,
    /// 1.02 to 1.5 [cost]
    double coldest = 0.7, hottest = 4, step = 1.1;
    /// Log likelihood that a temperature e times one costs: few sessions are simulated; 0.5 to 8
    /// [habit]
    double far_from_one = 2;
    /// Least probability, of a cause and of its absence; 1e-9 to 1e-3 [habit]
    double hardly = 1e-6;
  };
  /// Of a correction, on rows that were held out.
  struct Validation {
    int passes = 4;                 ///< of growth and noise; 1 to 10 [cost]
    std::size_t most_effects = 60;  ///< 20 to 100 [cost]
    double most_grown = 2100;       ///< equations, that are linearised at all; 720 to 10000 [cost]
    double tried = 0.05;  ///< least probable cause that is tried alone; 0.01 to 0.5 [cost]
    int most_tried = 4;   ///< 0 to 10 [cost]
    /// Probability that noise stays below; 1 - 1e-4 to 1 - 1e-8 [habit]
    double far = 1 - 1e-6;
    /// A validation row's prediction has an error of its own; 1 to 2 [physics]
    double beyond = 1.25;
    /// Of the rows, that may be false; more are no false readings: the machine or the cell is
    /// another one there; 0.1 to 0.4 [habit]
    double most_false = 0.2;
    int folds = 3;         ///< in which rows take turns at judging; 2 to 10 [cost]
    int stretches = 2;     ///< of a set's rows, in each fold; 1 to 5 [habit]
    int resamples = 1000;  ///< of blocks; 200 to 10000 [habit]
    /// Of which an interval is drawn: a sign test of fewer cannot reach 2.5 % on one side;
    /// 6 to 10 [habit]
    std::size_t fewest_blocks = 6;
    double beside_interval = 0.025;  ///< probability on either side of it; 0.005 to 0.16 [habit]
    /// Before over floor below which nothing can be said; 1 to 1.2 [habit]
    double within_floor = 1.05;
  };
  /// Rows that would tell causes apart.
  struct FurtherRows {
    int most_new = 12;  ///< that a step asks for; 4 to 40 [cost]
    int fewest = 3;     ///< that are worth a step; 1 to 6 [habit]
    int postures = 6;   ///< found for one place, the farthest is taken; 2 to 20 [cost]
    int tries = 8;      ///< blocks of random starts before a place is given up; 2 to 60 [cost]
    /// Units of readings that a joint moves at least in another posture; 0.2 to 1 [habit]
    double another = 0.5;
    double faster = 3;      ///< over the speed of the row; 1.5 to 5 [physics]
    double of_mass = 0.05;  ///< payload to add, over the robot's mass, where its file tells
                            ///< none; 0.02 to 0.1 [physics]
    double on_paper = 5;    ///< kg, of that where no mass is known; 0.5 to 10 [physics]
    /// Of the confusion at first, below which no row is worth it; 1e-4 to 0.02 [habit]
    double least_confusion = 0.002;
    double least_gain = 0.01;  ///< of the confusion now, that a row must take; 0 to 0.1 [habit]
  };
  /// Of noise that is not the same everywhere.
  struct Uneven {
    int fewest = 30;             ///< configurations that may show it; 20 to 60 [habit]
    double least_freedom = 0.2;  ///< of a configuration; 0.1 to 0.5 [habit]
    double by_chance = 1e-3;  ///< how often noise that is even shows as much; 1e-5 to 0.01 [habit]
    double times = 1.3;       ///< as much at one end as at the other; 1.1 to 2 [habit]
    /// Rows of the file, of which one may be unlike the others, and so many that may show it; what
    /// one that is put aside counts for, as a square over the noise; 4 to 32, 3 to 10, 9 to 100
    /// [habit]
    int most_every = 12, fewest_of_every = 5;
    double put_aside = 25;
    double probability = 0.8;  ///< of `unknown` then; 0.6 to 0.95 [trials]
  };
  /// Of two sessions, and of a machine with its simulator.
  struct Comparison {
    int passes = 2;  ///< false rows are seen once the changes are known; 1 to 5 [cost]
    std::size_t most_together = 3;      ///< changes that the search puts together; 2 to 5 [cost]
    std::size_t most_differences = 60;  ///< 20 to 100 [cost]
    double listed = 0.02;  ///< least probability of a change that is listed; 0 to 0.1 [habit]
    double shown = 0.5;    ///< the same, of an effect that a simulator lacks; 0.5 to 0.9 [habit]
    double unsure = 0.5;   ///< of structure that no difference explains; 0.3 to 0.9 [habit]
    /// Of the robot's size, or rad: a surface or instrument that stands so much elsewhere by the
    /// two sessions' own fits has moved, too far to be linear in it; 0.005 to 0.05 [physics]
    double elsewhere = 0.02;
    /// Sizes of a length (of the robot's size), an angle (rad) or a ratio that changes; 1e-6 to
    /// 1e-5, 1e-3 to 2e-2 [physics]
    double usual_least = 5e-6, usual_most = 5e-3;
    double apart = 3;         ///< sigmas of a figure that differs; 2 to 5 [habit]
    double alike = 1 - 1e-6;  ///< cosine of columns that no row tells apart [exact]
  };
  Rows rows;
  Structure structure;
  Evidence evidence;
  Shapes shapes;
  Naming naming;
  Simulation simulation;
  Validation validation;
  FurtherRows further_rows;
  Uneven uneven;
  Comparison comparison;
  ReportConstants report;
};

inline constexpr DiagnosisConstants kDiagnosis{};

}  // namespace selfcal
