/* What a study stands on: its file, the order of its blocks, its people. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/order.h"
#include "study/people.h"
#include "text/sha256.h"
#include "unit/suite.h"

static ethd__protocol protocol;
static char message[ETHD_MESSAGE_MAX];

static ethd_status parse(const char *text) {
  return ethd__protocol_parse(text, strlen(text), "x.study", ".", &protocol, message);
}

static void read(const char *text) { ck_assert_msg(parse(text) == ETHD_OK, "%s", message); }

/* ---- the file ---- */

TEST(test_an_empty_file_is_a_study) {
  read("");
  ck_assert_uint_eq(protocol.participants, 3);
  ck_assert_uint_eq(protocol.strategies.count, 2);
  ck_assert_str_eq(protocol.strategies.word[0], "smooth");
  ck_assert_str_eq(protocol.speeds.word[1], "high");
  ck_assert(isnan(protocol.band_low) && protocol.record && !protocol.survey && protocol.hands == ETHD_HANDS_SIMULATED);
  ck_assert_uint_eq(ethd__protocol_points(&protocol), 1);
  ethd__protocol_free(&protocol);
}

static const char everything[] =
    "[study]\nname = all\nseed = 18446744073709551615\nparticipants = 1000000\nstrategies = a, b ,c\nspeeds = low,0.3\n"
    "order = latin\ntraining = 0\ntaps = 100000\nattempts = 1000000\nsurvey = on\nrecord = none\n"
    "[device]\nconfig = c.ini\nplant = p\n[hand]\nsource = recorded\nmotion = free\nbetween = 1\nhand_spread = 0\n"
    "[validity]\nband_low = 0.05\nband_high = 0.1\ngraze = 0\nlift = 0.01\n[grid]\ncontact.k_e = 1,2,3\ntransition.b_d "
    "= 5,6\n";

TEST(test_every_key) {
  read(everything);
  ck_assert_str_eq(protocol.name, "all");
  ck_assert(protocol.seed == UINT64_MAX);
  ck_assert_str_eq(protocol.strategies.word[1], "b");
  ck_assert_int_eq(protocol.order, ETHD_ORDER_LATIN);
  ck_assert(protocol.survey && !protocol.record && protocol.hands == ETHD_HANDS_RECORDED);
  ck_assert_double_eq(protocol.band_high, 0.1);
  ck_assert_uint_eq(ethd__protocol_points(&protocol), 6);
  ck_assert_str_eq(ethd__protocol_value(&protocol, 0, 0), "1");
  ck_assert_str_eq(ethd__protocol_value(&protocol, 1, 1), "6");
  ck_assert_str_eq(ethd__protocol_value(&protocol, 5, 0), "3");
  ethd__protocol_free(&protocol);
}

TEST(test_attempts_follow_the_taps_that_are_wanted) {
  read("[study]\ntaps = 60\n");
  ck_assert_uint_eq(protocol.attempts, 800);
  ethd__protocol_free(&protocol);
  ck_assert_int_eq(parse("[study]\ntaps = 60\nattempts = 59\n"), ETHD_E_RANGE);
  static const char *const odd[] = {"3e0", "0x3", "3.0", "+3", "-3", "0", "100001", "18446744073709551616"};
  for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
    char text[64], words[ETHD_MESSAGE_MAX];
    snprintf(text, sizeof text, "[study]\ntaps = %s\n", odd[i]);
    snprintf(words, sizeof words, "x.study:2: study.taps: found \"%s\", a whole number from 1 to 100000 is allowed",
             odd[i]);
    ck_assert_int_eq(parse(text), ETHD_E_RANGE);
    ck_assert_str_eq(message, words);
  }
}

TEST(test_a_grid_has_an_end) {
  char text[2048] = "[grid]\n";
  for (int i = 0; i < 6; i++) sprintf(text + strlen(text), "a.k%d = 1,2,3,4,5,6,7,8\n", i);
  ck_assert_int_eq(parse(text), ETHD_E_RANGE); /* 8^6 */
  ck_assert_ptr_nonnull(strstr(message, "x.study:7: grid.a.k5"));
}

/* ---- order ---- */

static ethd__study_block blocks[ETHD_STUDY_BLOCKS];

static const char *order_of(uint32_t participant) {
  static char text[512];
  size_t count = ethd__order_of(&protocol, participant, blocks);
  *text = 0;
  for (size_t i = 0; i < count; i++)
    sprintf(text + strlen(text), "%s%c%zu", blocks[i].training ? "t" : "", (char)('A' + blocks[i].strategy),
            blocks[i].speed);
  return text;
}

TEST(test_the_papers_order) {
  read("");
  ck_assert_str_eq(order_of(0), "tA0B0A0tA1B1A1");
  ck_assert_str_eq(order_of(1), "tB0A0B0tB1A1B1");
  ck_assert_str_eq(order_of(2), "tA0B0A0tA1B1A1");
  ethd__protocol_free(&protocol);
  read("[study]\nstrategies = a,b,c\nspeeds = low\ntraining = 0\n");
  ck_assert_str_eq(order_of(0), "B0C0A0");
  ck_assert_str_eq(order_of(1), "C0A0B0");
  ck_assert_str_eq(order_of(2), "A0B0C0");
  ethd__protocol_free(&protocol);
}

/* Every cell as often at every place, and behind every other. */
static void check_latin(const char *text, size_t cells, uint32_t people) {
  size_t place[64][64] = {{0}}, after[64][64] = {{0}};
  read(text);
  size_t strategies = protocol.strategies.count;
  for (uint32_t p = 0; p < people; p++) {
    ck_assert_uint_eq(ethd__order_of(&protocol, p, blocks), cells);
    for (size_t i = 0, last = 0; i < cells; i++) {
      size_t cell = blocks[i].speed * strategies + blocks[i].strategy;
      place[cell][i]++;
      if (i) after[last][cell]++;
      last = cell;
    }
  }
  for (size_t a = 0; a < cells; a++)
    for (size_t b = 0; b < cells; b++) {
      ck_assert_uint_eq(place[a][b], people / cells);
      ck_assert_uint_eq(after[a][b], a == b ? 0 : people / cells);
    }
  ethd__protocol_free(&protocol);
}

TEST(test_latin_squares) {
  check_latin("[study]\norder = latin\ntraining = 0\n", 4, 8);
  check_latin("[study]\norder = latin\ntraining = 0\nstrategies = a,b,c\nspeeds = low\n", 3, 6);
  check_latin("[study]\norder = latin\ntraining = 0\nstrategies = a,b,c,d,e\nspeeds = low,high,0.3\n", 15, 30);
}

/* Each cell once, another order for most people, training before a speed's first cell. */
TEST(test_random_order) {
  char first[512];
  int others = 0;
  read("[study]\norder = random\nstrategies = a,b,c\n");
  snprintf(first, sizeof first, "%s", order_of(0));
  ck_assert_str_eq(order_of(0), first);
  for (uint32_t p = 0; p < 40; p++) {
    unsigned seen = 0, trained = 0;
    others += strcmp(order_of(p), first) != 0;
    size_t count = ethd__order_of(&protocol, p, blocks);
    ck_assert_uint_eq(count, 8);
    for (size_t i = 0; i < count; i++) {
      if (blocks[i].training) trained |= 1u << blocks[i].speed;
      ck_assert(trained >> blocks[i].speed & 1);
      if (!blocks[i].training) seen |= 1u << (blocks[i].speed * 3 + blocks[i].strategy);
    }
    ck_assert_uint_eq(seen, 63);
  }
  ck_assert_int_gt(others, 35);
  ethd__protocol_free(&protocol);
}

/* Trials: each round has every cell once, and over the square's rows each cell at each place; trainings come first. */
TEST(test_interleaved_trials) {
  size_t place[6][6] = {{0}}, repeats = 0;
  char first[512];
  read("[study]\norder = interleaved\nstrategies = a,b,c\ntaps = 4\n");
  snprintf(first, sizeof first, "%s", order_of(0));
  ck_assert_str_ne(order_of(1), first);
  for (uint32_t p = 0; p < 6; p++) {
    ck_assert_uint_eq(ethd__order_of(&protocol, p, blocks), 2 + 4 * 6);
    ck_assert(blocks[0].training && blocks[1].training && blocks[0].speed != blocks[1].speed);
    for (size_t round = 0; round < 4; round++)
      for (size_t i = 0; i < 6; i++) {
        const ethd__study_block *b = &blocks[2 + 6 * round + i];
        ck_assert(!b->training && b->round == round);
        place[3 * b->speed + b->strategy][i]++;
        repeats += i && b->strategy == b[-1].strategy && b->speed == b[-1].speed;
      }
  }
  for (size_t i = 0; i < 36; i++) ck_assert_uint_eq(place[i / 6][i % 6], 4);
  ck_assert_uint_eq(repeats, 0);
  ck_assert_uint_eq(ethd__block_taps(&protocol), 1);
  ck_assert_uint_eq(ethd__block_attempts(&protocol), 10);
  ethd__protocol_free(&protocol);
  read("[study]\norder = interleaved\nstrategies = a,b,c\ntaps = 4\nseed = 2\n");
  ck_assert_str_ne(order_of(0), first);
  ethd__protocol_free(&protocol);
  ck_assert_int_eq(parse("[study]\ntaps = 256\norder = interleaved\n"), ETHD_E_RANGE);
  ck_assert_str_eq(message, "x.study: study.order: 1026 interleaved trials and trainings; at most 1024 are allowed");
}

/* ---- people ---- */

/* What lies between and within people makes up what the plant says; radii are a person's. */
TEST(test_people) {
  ethd_plant plant;
  ck_assert_msg(!ethd_plant_load("apps/config/n.plant", &plant, message), "%s", message);
  enum { PEOPLE = 4000 };
  double pace = 0, square = 0, radius = 0;
  for (uint32_t i = 0; i < PEOPLE; i++) {
    ethd_plant own = ethd__person_plant(&plant, 7, i, 0.5, 0.15), again = ethd__person_plant(&plant, 7, i, 0.5, 0.15);
    ck_assert(!memcmp(&own, &again, sizeof own));
    ck_assert_double_eq(own.finger_radius_sd, 0);
    ck_assert_double_eq_tol(own.speed_high / plant.speed_high, own.speed_low / plant.speed_low, 1e-15);
    double p = own.speed_low / plant.speed_low - 1;
    pace += p, square += p * p, radius += own.finger_radius;
    ck_assert_double_eq_tol(own.speed_spread, plant.speed_spread * sqrt(0.5), 1e-15);
  }
  /* a normal that is cut at 2 sd has 0.880 of its sd */
  ck_assert_double_eq_tol(pace / PEOPLE, 0, 3 * plant.speed_spread / sqrt(PEOPLE));
  ck_assert_double_eq_tol(sqrt(square / PEOPLE), 0.880 * sqrt(0.5) * plant.speed_spread, 0.003);
  ck_assert_double_eq_tol(radius / PEOPLE, plant.finger_radius, 3 * plant.finger_radius_sd / sqrt(PEOPLE));
  ethd_plant none = ethd__person_plant(&plant, 7, 1, 0, 0);
  ck_assert_double_eq(none.speed_low, plant.speed_low);
  ck_assert_double_eq(none.hand_stiffness, plant.hand_stiffness);
  ck_assert(ethd__person_seed(7, 1) != ethd__person_seed(7, 2) && ethd__person_seed(7, 1) != ethd__person_seed(8, 1));
}

TEST(test_ids) {
  char id[ETHD_STUDY_ID_MAX];
  protocol = (ethd__protocol){.participants = 3};
  ethd__participant_id(&protocol, 2, id);
  ck_assert_str_eq(id, "P03");
  protocol.participants = 12345;
  ethd__participant_id(&protocol, 2, id);
  ck_assert_str_eq(id, "P00003");
}

/* ---- sums: FIPS 180-4's examples ---- */

static void sum_is(const char *text, size_t times, const char *expected) {
  char sum[ETHD_SHA256_TEXT];
  ethd__sha256 s;
  ethd__sha256_begin(&s);
  for (size_t i = 0; i < times; i++) ethd__sha256_add(&s, text, strlen(text));
  ethd__sha256_end(&s, sum);
  ck_assert_str_eq(sum, expected);
}

TEST(test_sha256) {
  sum_is("", 1, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  sum_is("abc", 1, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  sum_is("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 1,
         "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  sum_is("a", 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}
