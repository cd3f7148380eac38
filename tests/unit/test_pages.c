/* The screen's pages in windows from 320x200 to 4K: no text lies on another, on the room, or over the edge. With
   ETHD_PAGES=DIR each is written there as a picture (BMP). */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "screen/draw.h"
#include "study/dictionary.h"
#include "study/progress.h"

static const int sizes[][2] = {{320, 200}, {640, 400}, {720, 1280}, {1366, 768}, {3840, 2160}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static ethd__screen screen;
static SDL_Surface *pixels;

static void open_at(int width, int height) {
  const char *font = getenv("ETHD_FONT") ? getenv("ETHD_FONT") : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  memset(&screen, 0, sizeof screen);
  ethd__window *w = &screen.window;
  w->width = width, w->height = height, w->covered = true;
  ck_assert_int_eq(TTF_Init(), 0);
  for (int i = 0; i < ETHD_TEXTS; i++) ck_assert_ptr_nonnull(w->font[i] = TTF_OpenFont(font, 9));
  ethd__window_shrink(w, 1);
  screen.frame = ethd__room_of(0.238, 0.2816, 0.25, 0.0075, width, height);
  screen.speed = (ethd__speed){.centre = 0.4};
  pixels = SDL_CreateRGBSurfaceWithFormat(0, width, height, 32, SDL_PIXELFORMAT_RGB888);
  ck_assert_ptr_nonnull(pixels);
}

static void close_it(void) {
  ethd__window_forget(&screen.window);
  for (int i = 0; i < ETHD_TEXTS; i++) TTF_CloseFont(screen.window.font[i]);
  SDL_FreeSurface(pixels);
  TTF_Quit();
}

static void save(const char *name) {
  char path[512];
  if (!getenv("ETHD_PAGES")) return;
  snprintf(path, sizeof path, "%s/%s-%dx%d.bmp", getenv("ETHD_PAGES"), name, screen.window.width, screen.window.height);
  SDL_SaveBMP(pixels, path);
}

/* After a frame; texts of the frame, by their pictures. */
static void check_frame(const char *name, size_t texts) {
  const ethd__window *w = &screen.window;
  size_t found = 0;
  ethd__window_draw(&screen.window, pixels);
  save(name);
  for (size_t i = 0; i < w->shape_before; i++) {
    const ethd__window_shape *a = &w->shape[i];
    if (!a->text[0]) continue;
    found++;
    ck_assert_msg(a->at.x >= 0 && a->at.y >= 0 && a->at.x + a->at.w <= w->width && a->at.y + a->at.h <= w->height,
                  "%s at %d x %d: \"%s\" goes over the edge", name, w->width, w->height, a->text);
    ck_assert_msg(a->at.h >= 5 && a->at.w >= 1, "%s: \"%s\" can't be read", name, a->text);
    for (size_t k = 0; k < w->shape_before; k++) {
      const ethd__window_shape *b = &w->shape[k];
      bool counts = b->text[0] ? k > i : b->at.w > 0 && b->at.h > 0;
      ck_assert_msg(!counts || !SDL_HasIntersection(&a->at, &b->at), "%s at %d x %d: \"%s\" lies on \"%s\"", name,
                    w->width, w->height, a->text, b->text[0] ? b->text : "the room");
    }
  }
  ck_assert_msg(found >= texts, "%s: %zu texts of at least %zu", name, found, texts);
  screen.window.changed_count = 0;
}

static void draw(const char *name, const ethd__page *page, size_t texts) {
  ethd__page_draw(&screen.window, page);
  check_frame(name, texts);
}

static const char title[] = "P12   part 3 of 10, practice";

static void check_room(void) {
  static const struct {
    const char *name, *feedback, *achieved;
    bool device;
  } cases[] = {{"first", "", "", false},
               {"slow", "too slow   (2 of 3)", "0.12 m/s; from 0.14 to 0.26 m/s count", false},
               {"early", "touched the ring before the wall: keep the finger in the middle   (12 of 15)",
                "0.43 m/s; from 0.32 to 0.48 m/s count", true}};
  static const ethd__source source = {.self = NULL};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    snprintf(screen.title, sizeof screen.title, "%s", title);
    snprintf(screen.feedback, sizeof screen.feedback, "%s", cases[i].feedback);
    snprintf(screen.achieved, sizeof screen.achieved, "%s", cases[i].achieved);
    screen.device = cases[i].device ? &source : NULL;
    ethd__screen_waiting(&screen, (ethd_vec){0.27, 0.25}, 0.05);
    check_frame(cases[i].name, 3 + 2 * (*cases[i].feedback != 0));
  }
}

static void check_questions(void) {
  char text[ETHD_STUDY_ANSWERS][256];
  ethd__questionnaire q = {.own = false};
  const int16_t answer[ETHD_STUDY_QUESTIONS] = {1, 0, 5};
  ck_assert(ethd__questionnaire_fill(&q));
  for (int i = 0; i < 3; i++) {
    ethd__page page = {.title = title,
                       .keys = "1 to 5 choose, 0 no answer   Enter goes on   Backspace back   Esc stops"};
    ethd__page_of_question(&q.question[i], 2, &page, text);
    draw(i == 0 ? "question1" : i == 1 ? "question2" : "question3", &page, 8);
  }
  ethd__page page = {.title = title, .keys = "Enter keeps them   Backspace changes them   Esc stops"};
  ethd__page_of_answers(&q, answer, &page, text);
  ck_assert_ptr_nonnull(strstr(page.paragraph[2].text, "no answer"));
  draw("answers", &page, 6);
  ethd__questionnaire_free(&q);
  /* the most that a study can ask */
  ethd__question most = {
      (char *)"Wie deutlich haben Sie gespürt, dass die Wand, die Sie auf dem Bildschirm sahen, genau "
              "dann und genau dort war, wo Ihr Finger sie berührte, und nicht früher oder später?",
      (char *)"gar nicht | kaum | wenig | eher nicht | weder noch | eher | ziemlich | sehr | völlig", 0};
  ethd__page full = {.title = title, .keys = "1 to 9 choose, 0 no answer   Enter goes on   Backspace back   Esc stops"};
  ethd__page_of_question(&most, 9, &full, text);
  draw("question9", &full, 12);
}

static void check_words(void) {
  char *paragraph[ETHD_STUDY_PARAGRAPHS];
  ethd__page page;
  for (int i = 0; i < ETHD_STUDY_PARAGRAPHS; i++)
    paragraph[i] =
        (char *)"Sie nehmen freiwillig teil und können jederzeit ohne Angabe von Gründen aufhören; dann werden "
                "Ihre Daten nicht ausgewertet. Es dauert etwa eine Stunde, mit Pausen, wann Sie mögen.";
  ethd__page_of_words(paragraph, title, "Y I agree   N I don't   Esc stops", &page);
  draw("consent", &page, 11);
  char text[256];
  const ethd__meeting meeting = {"P12", true, false, true};
  ethd__page_of_hand_over(&meeting, "P1", &page, text);
  draw("hand-over", &page, 5);
}

START_TEST(test_no_text_lies_on_another) {
  for (int i = 0; i < SIZES; i++) {
    open_at(sizes[i][0], sizes[i][1]);
    check_room();
    check_questions();
    check_words();
    close_it();
  }
}
END_TEST

/* Letters are as large as the window allows, and large again on the next page. */
START_TEST(test_letters_shrink_only_where_they_must) {
  open_at(320, 200);
  check_words();
  int low = TTF_FontHeight(screen.window.font[ETHD_TEXT_SMALL]);
  ethd__page page = {.title = "", .keys = "Space ends"};
  ethd__page_add(&page, ETHD_TEXT_LARGE, "That was all. Thank you!", ethd__white);
  draw("end", &page, 2);
  ck_assert_int_ge(TTF_FontHeight(screen.window.font[ETHD_TEXT_SMALL]), low);
  ck_assert(screen.window.shrink == 1);
  close_it();
  open_at(1366, 768);
  check_room();
  ck_assert(screen.window.shrink > 0.8);
  close_it();
}
END_TEST

int main(void) {
  Suite *suite = suite_create("pages");
  TCase *tests = tcase_create("pages");
  tcase_set_timeout(tests, 60);
  tcase_add_test(tests, test_no_text_lies_on_another);
  tcase_add_test(tests, test_letters_shrink_only_where_they_must);
  suite_add_tcase(suite, tests);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed != 0;
}
