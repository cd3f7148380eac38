/* The study's journal: a line is written, then synced, then counts. The program may be killed and the power may fail
   at any moment; a write may fail in its middle, and cutting its rest off may fail too.

   = apps/study/journal.c: bool written = write_all(journal->fd, line, length, journal->length) && fdatasync(journal->fd) == 0;
   = apps/study/journal.c: journal->length += length;
   = apps/study/journal.c: (void)!ftruncate(journal->fd, (off_t)journal->length);
   = apps/study/journal.c: if (!newline || !part_line(at, (size_t)(newline - at), &journal->lines[journal->count])) break;
   = apps/study/journal.c: if (!status && read.cut && (ftruncate(out->fd, (off_t)read.length) || fsync(out->fd))) {

   Kept: a line that counted is there after every start; lines stand in order, none twice; no start is refused, for
   nothing stands behind a torn line. */
#ifndef STARTS
#define STARTS 3
#endif
#ifndef LINES
#define LINES 4
#endif

byte counted; /* lines that the program went on from: 1, 2 ... counted */
byte whole;   /* whole lines in the file */
byte synced;  /* of those, on the disk whatever happens */
bit torn;     /* a part of a line behind them */

active proctype program() {
  byte starts, length;
  bit alive, good;
  do
  :: starts < STARTS ->
     starts++;
     /* open: whole lines are read, a torn one is cut off */
     assert(whole >= counted);
     torn = 0;
     synced = whole;
     length = whole;
     counted = whole;
     alive = 1;
     do
     :: alive && counted < LINES ->
        good = 0;
        if
        :: torn = 1; /* some bytes of it, over whatever stood there */
           if
           :: torn = 0;
              whole = length + 1;
#ifdef BUG
              counted = whole; /* goes on before it is on the disk */
#endif
              if
              :: synced = whole; good = 1
              :: true /* the sync fails */
              fi
           :: true /* the write fails */
           fi
        :: true /* no byte was written */
        fi;
        if
        :: alive = 0 /* killed, or no power, right here */
        :: true
        fi;
        if
        :: alive && good -> length++; counted = length
        :: alive && !good -> /* cut back to what counts */
           if
           :: whole = length; torn = 0
           :: true /* that fails too: the rest stays behind, and is written over */
           fi
        :: else
        fi
     :: alive -> alive = 0 /* killed in between */
     :: !alive -> break
     od;
     if /* the power fails: what wasn't synced is whole, torn or gone */
     :: whole > synced -> whole = synced; torn = 1
     :: whole > synced -> whole = synced; torn = 0
     :: true
     fi
  :: else -> break
  od
}
