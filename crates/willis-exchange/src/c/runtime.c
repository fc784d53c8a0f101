/* Room for one equilibrium. */
typedef struct {
    double rho[@U@_E];
    double force[@U@_E];
    double relative[@U@_E];
    uint32_t pattern;
} @P@_work_t;

static int @P@_usable(double x)
{
    return ((x >= -@U@_LIMIT) && (x <= @U@_LIMIT)) ? 1 : 0;
}

/* Forces of the elements for given efficiencies: elimination with row exchange. Returns 1, or 0 without a solution. */
static int @P@_solve(const @P@_table_t *table, const double inputs[@U@_X], @P@_work_t *work)
{
    double m[@U@_E][@U@_E];
    int solved = 1;
    const uint32_t n = (uint32_t)table->elements;
    uint32_t r;
    uint32_t c;
    uint32_t k;

    for (r = 0u; r < n; r++) {
        double sum = 0.0;
        for (k = 0u; k < @U@_X; k++) {
            sum += table->right[r][k] * inputs[k];
        }
        work->force[r] = sum;
        for (c = 0u; c < n; c++) {
            m[r][c] = table->constant[r][c] + (table->slope[r][c] * work->rho[c]);
        }
    }
    for (c = 0u; (c < n) && (solved == 1); c++) {
        uint32_t pivot = c;
        double largest = 0.0;
        for (r = c; r < n; r++) {
            const double size = (m[r][c] < 0.0) ? -m[r][c] : m[r][c];
            if (size > largest) {
                largest = size;
                pivot = r;
            }
        }
        if (largest > 0.0) {
            if (pivot != c) {
                const double f = work->force[c];
                work->force[c] = work->force[pivot];
                work->force[pivot] = f;
                for (k = c; k < n; k++) {
                    const double x = m[c][k];
                    m[c][k] = m[pivot][k];
                    m[pivot][k] = x;
                }
            }
            for (r = c + 1u; r < n; r++) {
                const double factor = m[r][c] / m[c][c];
                for (k = c; k < n; k++) {
                    m[r][k] -= factor * m[c][k];
                }
                work->force[r] -= factor * work->force[c];
            }
        } else {
            solved = 0;
        }
    }
    if (solved == 1) {
        for (c = n; c > 0u; c--) {
            double sum = work->force[c - 1u];
            for (k = c; k < n; k++) {
                sum -= m[c - 1u][k] * work->force[k];
            }
            work->force[c - 1u] = sum / m[c - 1u][c - 1u];
        }
    }
    return solved;
}

/* What came of a pattern of drivers. */
#define @U@_FITS 0
#define @U@_FITS_IDLE 1
#define @U@_CONTRADICTS 2
#define @U@_SINGULAR 3

/* Tries the pattern in the work: a bit for each element whose direction of power matters, clear where its end p
   drives. An element at rest transmits without loss. `wrong` is the first bit that is contradicted. */
static int @P@_try(const @P@_table_t *table, const double inputs[@U@_X], @P@_work_t *work, uint32_t *wrong)
{
    int found = @U@_FITS;
    uint32_t e;
    uint32_t b;

    for (e = 0u; e < (uint32_t)table->elements; e++) {
        work->rho[e] = table->rho[e][0];
    }
    for (b = 0u; b < (uint32_t)table->movings; b++) {
        const uint32_t at = (uint32_t)table->moving[b];
        const uint32_t side = (work->pattern >> b) & 1u;
        if ((work->relative[at] < 0.0) || (work->relative[at] > 0.0)) {
            work->rho[at] = table->rho[at][side];
        } else {
            work->rho[at] = 1.0;
        }
    }
    if (@P@_solve(table, inputs, work) == 0) {
        found = @U@_SINGULAR;
    } else {
        for (b = 0u; (b < (uint32_t)table->movings) && (found != @U@_CONTRADICTS); b++) {
            const uint32_t at = (uint32_t)table->moving[b];
            const double drive = work->force[at] * work->relative[at];
            if (((work->pattern >> b) & 1u) == 0u) {
                if (drive < 0.0) {
                    found = @U@_CONTRADICTS;
                    *wrong = b;
                }
            } else if (drive > 0.0) {
                found = @U@_CONTRADICTS;
                *wrong = b;
            } else if (!(drive < 0.0)) {
                found = @U@_FITS_IDLE;
            } else {
                /* It fits. */
            }
        }
    }
    return found;
}

/* Finds the equilibrium into `work`. At most 2^movings + 1 trials where there is one for every load, else 2^movings. */
static @P@_verdict_t @P@_find(const @P@_table_t *table, const double inputs[@U@_X], @P@_work_t *work)
{
    const uint32_t patterns = (uint32_t)1u << (uint32_t)table->movings;
    uint32_t resting = 0u;
    uint32_t solutions = 0u;
    uint32_t wrong = 0u;
    uint32_t k;

    for (k = 0u; k < (uint32_t)table->movings; k++) {
        const double relative = work->relative[table->moving[k]];
        if (!((relative < 0.0) || (relative > 0.0))) {
            resting |= (uint32_t)1u << k;
        }
    }
    if (table->certified == 1u) {
        int found = @U@_CONTRADICTS;
        work->pattern = 0u;
        for (k = 0u; (k <= patterns) && (found == @U@_CONTRADICTS); k++) {
            found = @P@_try(table, inputs, work, &wrong);
            if (found == @U@_CONTRADICTS) {
                work->pattern ^= (uint32_t)1u << wrong;
            }
        }
        if ((found == @U@_FITS) || (found == @U@_FITS_IDLE)) {
            solutions = 1u;
        }
    }
    if (solutions == 0u) {
        @P@_work_t trial = *work;
        for (k = 0u; (k < patterns) && (solutions < 2u); k++) {
            trial.pattern = k;
            if ((k & resting) == 0u) {
                if (@P@_try(table, inputs, &trial, &wrong) == @U@_FITS) {
                    if (solutions == 0u) {
                        *work = trial;
                    }
                    solutions++;
                }
            }
        }
    }
    return (solutions == 0u) ? @U@_LOCKED : ((solutions == 1u) ? @U@_UNIQUE : @U@_SEVERAL);
}

static double @P@_torque(const @P@_table_t *table, uint32_t output, const double inputs[@U@_X], const @P@_work_t *work)
{
    double torque = 0.0;
    uint32_t k;

    if (table->kind[output] == @U@_KIND_INPUT) {
        torque = inputs[table->input[output]];
    } else if (table->kind[output] == @U@_KIND_LINEAR) {
        for (k = 0u; k < @U@_X; k++) {
            torque += table->direct[output][k] * inputs[k];
        }
        for (k = 0u; k < (uint32_t)table->elements; k++) {
            torque += work->force[k] * (table->at_zero[output][k] + (table->at_rho[output][k] * work->rho[k]));
        }
    } else {
        /* Open, or not determined by statics. */
    }
    return torque;
}

@DRAG@
static void @P@_clear(@P@_result_t *result)
{
    uint32_t k;

    for (k = 0u; k < @U@_MEMBERS; k++) {
        result->speed[k] = 0.0;
        result->speed_known[k] = 0u;
    }
    for (k = 0u; k < @U@_TERMINALS; k++) {
        result->torque[k] = 0.0;
    }
    for (k = 0u; k < @U@_ROOM(@U@_SHIFT_ELEMENTS); k++) {
        result->shift_torque[k] = 0.0;
        result->shift_torque_known[k] = 0u;
    }
    for (k = 0u; k < @U@_ROOM(@U@_MESHES); k++) {
        result->mesh_loss[k] = 0.0;
    }
    for (k = 0u; k < @U@_ROOM(@U@_DRAGS); k++) {
        result->drag_loss[k] = 0.0;
    }
    result->loss = 0.0;
    result->power_in = 0.0;
    result->efficiency = 0.0;
}

/* Everything that follows from an equilibrium. */
static void @P@_fill(const @P@_table_t *table, const double inputs[@U@_X], const @P@_work_t *work, @P@_result_t *result)
{
    uint32_t k;
    uint32_t b;

    for (k = 0u; k < @U@_TERMINALS; k++) {
        const double torque = @P@_torque(table, k, inputs, work);
        const double power = torque * result->speed[@P@_terminal_member[k]];
        result->torque[k] = torque;
        result->loss += power;
        if (power > 0.0) {
            result->power_in += power;
        }
    }
    for (k = 0u; k < @U@_SHIFT_ELEMENTS_N; k++) {
        result->shift_torque[k] = @P@_torque(table, @U@_TERMINALS + k, inputs, work);
        result->shift_torque_known[k] = (table->kind[@U@_TERMINALS + k] == @U@_KIND_UNKNOWN) ? (uint8_t)0u : (uint8_t)1u;
    }
    for (k = 0u; k < @U@_MESHES_N; k++) {
        const uint32_t at = (uint32_t)table->element_of_mesh[k];
        if (at < (uint32_t)table->elements) {
            const double power = work->force[at] * work->relative[at] * table->arm[at];
            uint32_t side = 0u;
            for (b = 0u; b < (uint32_t)table->movings; b++) {
                if ((uint32_t)table->moving[b] == at) {
                    side = (work->pattern >> b) & 1u;
                }
            }
            result->mesh_loss[k] = power * table->share[k][side];
        }
    }
    if (result->power_in > 0.0) {
        result->efficiency = (result->power_in - result->loss) / result->power_in;
    }
}

@P@_verdict_t @P@_evaluate(@P@_state_t state, const double speeds[@U@_SPEEDS], const double torques[@U@_ROOM(@U@_TORQUES)],
    @P@_result_t *result)
{
    @P@_verdict_t verdict = @U@_OUT_OF_RANGE;
    const uint32_t row = (uint32_t)state;
    int usable = (row < @U@_STATES) ? 1 : 0;
    uint32_t k;
    uint32_t i;

    @P@_clear(result);
    for (k = 0u; k < @U@_SPEEDS; k++) {
        if (@P@_usable(speeds[k]) == 0) {
            usable = 0;
        }
    }
    for (k = 0u; k < @U@_TORQUES_N; k++) {
        if (@P@_usable(torques[k]) == 0) {
            usable = 0;
        }
    }
    if (usable == 1) {
        const @P@_table_t *table = &@P@_tables[row];
        double inputs[@U@_X];
        @P@_work_t work;
        for (k = 0u; k < @U@_X; k++) {
            inputs[k] = 0.0;
        }
        for (k = 0u; k < @U@_TORQUES_N; k++) {
            inputs[k] = torques[k];
        }
        for (k = 0u; k < @U@_MEMBERS; k++) {
            result->speed_known[k] = table->speed_known[k];
            for (i = 0u; i < @U@_SPEEDS; i++) {
                result->speed[k] += table->speed[k][i] * speeds[i];
            }
        }
        work.pattern = 0u;
        for (k = 0u; k < @U@_E; k++) {
            work.rho[k] = 1.0;
            work.force[k] = 0.0;
            work.relative[k] = 0.0;
            for (i = 0u; i < @U@_SPEEDS; i++) {
                work.relative[k] += table->relative[k][i] * speeds[i];
            }
        }
@DRAG_CALL@        verdict = @P@_find(table, inputs, &work);
        if (verdict != @U@_LOCKED) {
            @P@_fill(table, inputs, &work, result);
        }
    }
    result->verdict = verdict;
    return verdict;
}
