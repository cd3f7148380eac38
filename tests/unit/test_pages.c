/* The screen's pages in windows from 320x200 to 4K: no text lies on another, on the room, or over the edge. With
   ETHD_PAGES=DIR each is written there as a picture (BMP). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "screen/draw.h"
#include "screen/letters.h"
#include "study/dictionary.h"
#include "study/progress.h"
#include "unit/suite.h"

static const int sizes[][2] = {{320, 200}, {640, 480}, {720, 1280}, {1366, 768}, {3840, 2160}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static const double walls[ETHD_WALLS] = {0.238, 0.368, 0.165, 0.335};
static ethd__screen screen;
static ethd__protocol protocol;
static SDL_Surface *pixels;

static void open_at(int width, int height) {
  const char *font = getenv("ETHD_FONT") ? getenv("ETHD_FONT") : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  memset(&screen, 0, sizeof screen);
  ethd__window *w = &screen.window;
  w->width = width, w->height = height, w->covered = true;
  ck_assert_int_eq(TTF_Init(), 0);
  for (int i = 0; i < ETHD_TEXTS; i++) ck_assert_ptr_nonnull(w->font[i] = TTF_OpenFont(font, 9));
  ethd__window_shrink(w, 1);
  screen.frame = ethd__room_of(walls, (ethd_vec){0.2816, 0.25}, 0.0075, width, height);
  screen.speed = (ethd__speed){.centre = 0.4};
  screen.protocol = &protocol;
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
    ethd__screen_waiting(&screen, false, (ethd_vec){0.27, 0.25}, 0.05);
    check_frame(cases[i].name, 3 + 2 * (*cases[i].feedback != 0));
  }
}

static void check_questions(void) {
  char text[ETHD_STUDY_ANSWERS][256];
  ethd__questionnaire q = {.own = false};
  const int16_t answer[ETHD_STUDY_QUESTIONS] = {1, 0, 5};
  const ethd__asked asked = {.question = q.question[ETHD_ASK_BLOCK], .count = 3, .answer = answer};
  ck_assert(ethd__questionnaire_fill(&q));
  for (int i = 0; i < 3; i++) {
    ethd__page page = {.title = title,
                       .keys = "1 to 5 choose, 0 no answer   Enter goes on   Backspace back   Esc stops"};
    ethd__page_of_question(&q.question[ETHD_ASK_BLOCK][i], 2, &page, text);
    draw(i == 0 ? "question1" : i == 1 ? "question2" : "question3", &page, 8);
  }
  ethd__page page = {.title = title, .keys = "Enter keeps them   Backspace changes them   Esc stops"};
  ethd__page_of_answers(&q, &asked, &page, text);
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
  ethd__page page;
  char text[256];
  const ethd__meeting meeting = {"P12", true, false, true};
  ethd__page_of_hand_over(&protocol.questionnaire, &meeting, "P1", &page, text);
  draw("hand-over", &page, 5);
}

/* ---- prose ---- */

/* Adds what isn't blank. */
static void squeeze(char *out, const char *text) {
  char *to = out + strlen(out);
  for (; *text; text++)
    if (!strchr(" \n", *text)) *to++ = *text;
  *to = 0;
}

/* The white texts of this frame: the title and the keys are grey. */
static void keep_prose(char *out) {
  const ethd__window *w = &screen.window;
  for (size_t i = 0; i < w->shape_before; i++)
    if (w->shape[i].colour.r == 255) squeeze(out, w->shape[i].text);
}

/* Prose for a study: languages, " ;" and "#", a word that is longer than any line. */
static char *prose_of(size_t bytes) {
  static const char *const sentences[] = {
      "Touchez le mur vert ; puis revenez à la ligne grise # et attendez. ",
      "Sie nehmen freiwillig teil und können jederzeit ohne Angabe von Gründen aufhören. ",
      "Коснитесь зелёной стены один раз, затем вернитесь к серой линии и подождите. ",
      "Αγγίξτε μία φορά τον πράσινο τοίχο και περιμένετε. ",
      "Donaudampfschifffahrtsgesellschaftskapitänsmützenabzeichenverordnungsdonaudampfschifffahrtsgesellschaft\n",
  };
  char *text = calloc(1, bytes + 256);
  for (size_t n = 0, i = 0; n < bytes; n = strlen(text), i++) strcat(text + n, sentences[i * i % 7 % 5]);
  return text;
}

static void read_all(const char *name, const char *text) {
  const ethd__page page = {.title = "P12   page 100 of 100",
                           .keys = "Space next page   Backspace page before   Esc stops"};
  char *seen = calloc(1, strlen(text) + 1), *asked = calloc(1, strlen(text) + 1);
  size_t pages = 0;
  for (const char *at = text; *at; pages++) {
    size_t n = ethd__page_room(&screen.window, &page, at);
    char *part = strndup(at, n);
    ethd__page shown = page;
    ethd__page_add(&shown, ETHD_TEXT_SMALL, part, ethd__white);
    draw(pages == 1 ? name : "prose", &shown, 3);
    ck_assert_msg(screen.window.shrink == 1, "%s: page %zu has smaller letters", name, pages);
    keep_prose(seen);
    free(part);
    at += n;
  }
  squeeze(asked, text);
  ck_assert_msg(!strcmp(seen, asked), "%s at %d x %d: lost", name, screen.window.width, screen.window.height);
  free(seen);
  free(asked);
}

/* As a study file gives it: nothing of it is cut, wherever it stands, and no page loses a letter. */
TEST(test_prose_loses_nothing) {
  char *text = prose_of(100000), message[ETHD_MESSAGE_MAX], *file, *line = text;
  size_t length;
  FILE *out = open_memstream(&file, &length);
  fputs("[pages]\n", out);
  for (int i = 0; i < 98; i++)
    fprintf(out, "instruction%d = %.*s\n", i + 1, (int)strcspn(line, "\n"), line), line += strcspn(line, "\n") + 1;
  for (char *p = line; *p; p++)
    if (*p == '\n') *p = ' '; /* the last paragraph is most of it */
  fprintf(out, "instruction99 = %s\n[study]\nname = long ; a comment\n", line);
  ck_assert(!fclose(out) && strlen(line) > 50000);
  ck_assert_msg(!ethd__protocol_parse(file, length, "a.study", ".", &protocol, message), "%s", message);
  char *read = calloc(1, length), *written = calloc(1, length);
  squeeze(read, protocol.questionnaire.instruction);
  squeeze(written, text);
  ck_assert(!strcmp(read, written));
  ck_assert_str_eq(protocol.name, "long");
  for (int i = 0; i < SIZES; i++) {
    open_at(sizes[i][0], sizes[i][1]);
    ck_assert_msg(!ethd__letters_check(&protocol.questionnaire, screen.window.font[0], message), "%s", message);
    read_all("prose2", protocol.questionnaire.instruction);
    close_it();
  }
  ethd__protocol_free(&protocol);
  free(read);
  free(written);
  free(text);
  free(file);
}

TEST(test_no_text_lies_on_another) {
  for (int i = 0; i < SIZES; i++) {
    open_at(sizes[i][0], sizes[i][1]);
    check_room();
    check_questions();
    check_words();
    close_it();
  }
}

/* ---- the walls ---- */

static bool is_green(ethd_vec x) {
  ethd_vec at = ethd__room_pixel(&screen.frame, x);
  uint8_t r, g, b;
  SDL_GetRGB(((uint32_t *)pixels->pixels)[(int)at.y * pixels->pitch / 4 + (int)at.x], pixels->format, &r, &g, &b);
  return g == ethd__green.g && r == ethd__green.r;
}

/* The room is the scene's: a wall is green where there is one, and only there. */
TEST(test_walls_are_the_scenes) {
  static const struct {
    const char *text;
    double left, right, bottom, top;
    bool all;
  } cases[] = {{"[scene]\nfile = room.scene\n", 0.238, 0.368, 0.165, 0.335, true},
               {"[scene]\nfile = wall.scene\n", 0.238, 0.3045, 0.23005, 0.26995, false}};
  for (size_t i = 0; i < 2; i++) {
    char message[ETHD_MESSAGE_MAX];
    ethd__desk desk = {.study = {.plant = {.start = 0.0315, .finger_radius = 0.008}}};
    ethd__loaded loaded = {0};
    ck_assert_msg(
        !ethd_config_parse(cases[i].text, strlen(cases[i].text), "test", "apps/config", &loaded.config, message), "%s",
        message);
    desk.loaded = &loaded;
    desk.study.config = loaded.config;
    ck_assert_msg(!ethd__study_prepare(&desk.study, message), "%s", message);
    open_at(1024, 768);
    screen.desk = &desk;
    ethd__draw_fit(&screen);
    const ethd__room *f = &screen.frame;
    ck_assert_double_eq_tol(f->left, cases[i].left, 1e-12);
    ck_assert_double_eq_tol(f->right, cases[i].right, 1e-12);
    ck_assert_double_eq_tol(f->bottom, cases[i].bottom, 1e-12);
    ck_assert_double_eq_tol(f->top, cases[i].top, 1e-12);
    ck_assert(f->start.y == 0.25);
    ethd__draw_room(&screen, f->start, -1);
    check_frame("walls", 0);
    double x = (f->left + f->start.x) / 2, y = f->start.y + 0.01, out = 0.03 * (f->top - f->bottom);
    ck_assert(is_green((ethd_vec){f->left - out, y}) && !is_green((ethd_vec){x, y}));
    ck_assert_int_eq(is_green((ethd_vec){f->right + out, y}), cases[i].all);
    ck_assert_int_eq(is_green((ethd_vec){x, f->bottom - out}), cases[i].all);
    ck_assert_int_eq(is_green((ethd_vec){x, f->top + out}), cases[i].all);
    close_it();
    ethd_config_free(loaded.config);
  }
}

/* ---- a study in German ---- */

static char drawn[1 << 16]; /* every text of the frames since it was emptied, a line each */

static void keep_texts(void) {
  for (size_t i = 0; i < screen.window.shape_before; i++)
    if (screen.window.shape[i].text[0])
      snprintf(drawn + strlen(drawn), sizeof drawn - strlen(drawn), "%s\n", screen.window.shape[i].text);
}

static void draw_german(const char *name, const ethd__page *page, size_t texts) {
  draw(name, page, texts);
  keep_texts();
}

static void judge_taps(void) {
  ethd__front front = ethd__screen_front(&screen);
  const ethd__speed speed = {.centre = 0.4, .band = 0.08};
  snprintf(screen.title, sizeof screen.title, "P12   Teil 3 von 10, Übung");
  ethd__taken taken = {.speed = &speed, .result = {.metrics = {.v_rvo = 0.43}}};
  for (int reason = 0; reason < ETHD_TAP_REASON_COUNT; reason++) {
    taken.result.metrics.reason = (ethd__reason)reason;
    const ethd__tally tally = {.taken = 4, .valid = 2, .wanted = 3, .accepted = 1, .rejected = 1};
    front.verdict(front.self, "P12", &taken, &tally);
    ethd__screen_waiting(&screen, false, (ethd_vec){0.27, 0.25}, 0.05);
    check_frame(reason ? "german-early" : "german-valid", 5);
    keep_texts();
  }
}

static void ask_in_german(void) {
  const ethd__questionnaire *q = &protocol.questionnaire;
  const int16_t answer[ETHD_STUDY_QUESTIONS] = {1, 5, 0, 1};
  const ethd__asked asked = {.question = q->question[ETHD_ASK_BLOCK],
                             .count = 4,
                             .answer = answer,
                             .said = {"", "", "", "Die Wand fühlte sich weich an."}};
  char text[ETHD_STUDY_ANSWERS][256];
  for (int i = 0; i < 3; i++) {
    ethd__page page = {.title = screen.title, .keys = ethd__screen_words(&screen, ETHD_PHRASE_KEYS_TEXT)};
    ethd__page_of_question(&q->question[ETHD_ASK_BLOCK][i], 2, &page, text);
    draw_german(i ? "german-question2" : "german-question1", &page, 8);
  }
  ethd__page page = {.title = screen.title, .keys = ethd__screen_words(&screen, ETHD_PHRASE_KEYS_ANSWERS)};
  ethd__page_of_answers(q, &asked, &page, text);
  ck_assert_str_eq(page.paragraph[4].text, "4   Die Wand fühlte sich weich an.");
  draw_german("german-answers", &page, 7);
}

static void meet_in_german(void) {
  const ethd__questionnaire *q = &protocol.questionnaire;
  const ethd__meeting meeting = {"P12", true, false, true};
  ethd__page page;
  char text[256];
  page = (ethd__page){.title = screen.title, .keys = ethd__screen_words(&screen, ETHD_PHRASE_KEYS_CONSENT)};
  ethd__page_add(&page, ETHD_TEXT_SMALL, q->consent, ethd__white);
  draw_german("german-consent", &page, 4);
  ethd__page_of_hand_over(q, &meeting, "P1", &page, text);
  draw_german("german-hand-over", &page, 5);
}

TEST(test_a_study_in_german) {
  static const char *const said[] = {"gültig   (2 von 3)\n",
                                     "0.43 m/s, es zählen 0.32 bis 0.48 m/s   bestätigt: 1, verworfen: 1\n",
                                     "Den Kreis zur grauen Linie führen und warten\n",
                                     "> 2   natürlich <\n",
                                     "4   Die Wand fühlte sich weich an.\n",
                                     "Versuchsleitung: Wenn P12 hier sitzt, P12 tippen und Eingabe drücken\n"};
  static const char *const english[] = {"Esc stop", "Space", "Enter",        "valid",
                                        "too ",     "count", "Experimenter", "no answer"};
  char message[ETHD_MESSAGE_MAX];
  ck_assert_msg(!ethd__protocol_load("apps/config/german.study", &protocol, message), "%s", message);
  for (int i = 0; i < ETHD_PHRASES; i++)
    ck_assert_msg(protocol.questionnaire.phrase[i] != NULL, "german.study has no %s", ethd__phrases[i].key);
  for (int i = 0; i < SIZES; i++) {
    open_at(sizes[i][0], sizes[i][1]);
    ck_assert_msg(!ethd__letters_check(&protocol.questionnaire, screen.window.font[0], message), "%s", message);
    drawn[0] = 0;
    judge_taps();
    ask_in_german();
    meet_in_german();
    for (size_t k = 0; i >= 3 && k < sizeof said / sizeof *said; k++)
      ck_assert_msg(strstr(drawn, said[k]) != NULL, "not drawn: %s", said[k]);
    for (size_t k = 0; k < sizeof english / sizeof *english; k++)
      ck_assert_msg(!strstr(drawn, english[k]), "still English: %s", english[k]);
    close_it();
  }
  ethd__protocol_free(&protocol);
}

static void press(SDL_Keycode key) {
  SDL_Event e = {.key = {.type = SDL_KEYDOWN, .keysym = {.sym = key}}};
  ck_assert_int_eq(SDL_PushEvent(&e), 1);
}

/* Who types another one's number is told so, and is asked again. */
TEST(test_another_number) {
  const ethd__meeting meeting = {"P12", true, false, false};
  SDL_Event typed = {.text = {.type = SDL_TEXTINPUT, .text = "P2"}};
  char message[ETHD_MESSAGE_MAX];
  bool said = false;
  ck_assert_int_eq(setenv("SDL_VIDEODRIVER", "dummy", 1), 0);
  memset(&screen, 0, sizeof screen);
  screen.protocol = &protocol;
  ck_assert_msg(!ethd__window_open(&screen.window, "pages", 640, 480, message), "%s", message);
  press(SDLK_SPACE); /* a page's first frame takes no letters */
  SDL_PushEvent(&typed);
  press(SDLK_2);
  press(SDLK_RETURN);
  press(SDLK_SPACE);
  press(SDLK_ESCAPE);
  ck_assert_int_eq(ethd__screen_meet(&screen, &meeting), ETHD_WISH_STOP);
  for (size_t i = 0; i < ETHD_SHAPES_MAX; i++)
    said |= !strcmp(screen.window.shape[i].text, "\"P2\" was typed; it is the turn of P12");
  ck_assert(said);
  ethd__window_close(&screen.window);
}

TEST(test_letters_that_the_font_lacks) {
  static const struct {
    const char *study, *message;
  } cases[] = {
      {"[words]\ntap = \xe6\x95\xb2\n", "[words] tap: the font DejaVu Sans has no letter \"\xe6\x95\xb2\" (U+6572)"},
      {"[pages]\nconsent2 = a\xf0\x9f\x91\x86\n", "[pages] consent: the font DejaVu Sans has no letter"},
      {"[study]\nsurvey = on\n[survey]\nq1 = \xe4\xbd\xa0?\n", "[survey] q1: the font"},
      {"[study]\nsurvey = on\n[survey]\nq1 = a\nq1_answers = b | \xe4\xbd\xa0\n", "[survey] q1_answers: the font"}};
  char message[ETHD_MESSAGE_MAX];
  open_at(640, 400);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const char *study = cases[i].study;
    ck_assert_msg(!ethd__protocol_parse(study, strlen(study), "a.study", ".", &protocol, message), "%s", message);
    ck_assert_int_lt(ethd__letters_check(&protocol.questionnaire, screen.window.font[0], message), 0);
    ck_assert_msg(!strncmp(message, cases[i].message, strlen(cases[i].message)), "%s", message);
    ethd__protocol_free(&protocol);
  }
  close_it();
}

/* Letters are as large as the window allows, and large again on the next page. */
TEST(test_letters_shrink_only_where_they_must) {
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
