/* Ball bearings of the library with tables of many sizes, each in memory of exactly its size, and with numbers of any kind:
 * what is not refused must be finite, and no load may be negative. A part of `hostile_kernel.c`. */

/* A law of a ball's contact: dry, or with a film whose table is of any size; free its table. */
static ehd_pair_law pair_law(int dry) {
    ehd_pair_law law = {1e10 * (0.5 + part()), 100.0 * part(), 1e-5 * part(), 0.0, 1.0, 0.0, 1.0, 0, NULL};
    if (dry) return law;
    law.rows = 1 + up_to(30);
    law.centre = -1e-7 * part();
    law.scale = 1e-7 * (0.5 + part());
    law.first = -6.0;
    law.step = 12.0 / (double)(law.rows - 1);
    double *table = room(4 * law.rows), g = -18.0;
    for (int64_t i = 0; i < law.rows; i++, g += 8.0 / (double)law.rows) {
        table[4 * i] = g;
        table[4 * i + 1] = 8.0 / (double)law.rows;
        table[4 * i + 2] = 4.0 * part();
        table[4 * i + 3] = part() - 0.5;
    }
    law.table = table;
    return law;
}

/* A bearing of any number of balls, at any pose and speed, with films that hold anything. */
static int balls(void) {
    const int64_t count = up_to(12);
    const double apart = 0.4e-3, angle = part() < 0.5 ? 0.0 : 0.7 * (part() - 0.5), arm = 22e-3;
    double pose[6], out[78], law[3], held[3], *cosine = room(count), *sine = room(count), *kept = room(2 * EHD_BALL_MEMORY * count);
    double *rows = room(4 * count);
    const int one = part() < 0.5;
    ehd_ball_start *start = calloc((size_t)count, sizeof *start);
    ehd_ball_found *found = calloc((size_t)count, sizeof *found);
    const int dry = part() < 0.3, with_memory = !dry && part() < 0.5;
    int failed = 0;
    for (int64_t j = 0; j < count; j++) {
        cosine[j] = cos(6.283 * (double)j / (double)count);
        sine[j] = sin(6.283 * (double)j / (double)count);
        rows[4 * j] = part() < 0.5 ? 1.0 : -1.0;
        rows[4 * j + 1] = number(1e-2);
        rows[4 * j + 2] = number(1e-5);
        rows[4 * j + 3] = j + 1 < count && part() < 0.5 ? 1.0 : 0.0;
    }
    for (int64_t i = 0; i < 2 * count; i++) {
        double *contact = kept + i * EHD_BALL_MEMORY;
        memset(contact, 0, sizeof(double) * EHD_BALL_MEMORY);
        contact[EHD_PAIR_PULL] = number(100.0);
        contact[EHD_PAIR_SPRING] = number(1e8);
        contact[EHD_PAIR_AT] = number(1e-6);
    }
    ehd_ball_data data = {{apart * sin(angle), apart * cos(angle) - 1e-5 * (part() - 0.5), arm, 0.5 * apart, 0.5 * apart,
                           apart, apart / arm},
                          {0.0, 0.0, part() < 0.2 ? 100.0 * part() : NAN, 0.2, 1e-4, 5e-5, (double)(any() % 4)},
                          0.0, 0.0, count, cosine, sine, one ? NULL : rows, with_memory ? kept : NULL, pair_law(dry), pair_law(dry),
                          NULL, NULL};
    for (int turn = 0; turn < 4; turn++) {
        double size = 0.0, kept_size = 0.0;
        for (int i = 0; i < 6; i++) pose[i] = number(i < 3 ? 3e-5 : 1e-3);
        data.drive.inner = number(1000.0);
        data.drive.outer = number(300.0);
        data.cage_angle = number(3.0);
        size = fabs(data.drive.inner) + fabs(data.drive.outer);
        data.rest = ehd_pair_approach(&data.outer, 1e-4 * number(500.0), number(1e-6));
        for (int64_t i = 0; with_memory && i < 2 * EHD_BALL_MEMORY * count; i++) kept_size += fabs(kept[i]);
        const int loaded = ehd_ball_force_surely(&data, pose, start, found, out, out + 6, out + 42);
        if (loaded > count) failed = 10;
        for (int i = 0; i < 78; i++)
            if (loaded >= 0 && size < 1e5 && kept_size < 1e12 && !isfinite(out[i])) failed = 11;
        for (int64_t j = 0; j < count; j++)
            if (loaded >= 0 && size < 1e5 && kept_size < 1e12 && (found[j].load[0] < 0.0 || found[j].load[1] < 0.0))
                failed = 12;
        if (loaded >= 0) ehd_ball_angles(count, found);
        const double approach = number(1e-6);
        for (int i = 0; i < 3; i++) held[i] = number(i == 0 ? 100.0 : i == 1 ? 1e8 : 1e-6);
        ehd_pair_contacts(&data.inner, 1, &approach, held, law);
        if (fabs(approach) < 1.0 && fabs(held[0]) + fabs(held[1]) + fabs(held[2]) < 1e12 && !(law[0] >= 0.0)) failed = 13;
    }
    free((void *)data.inner.table);
    free((void *)data.outer.table);
    free(cosine);
    free(sine);
    free(kept);
    free(rows);
    free(start);
    free(found);
    return failed;
}
