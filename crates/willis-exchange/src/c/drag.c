/* Torque of a drag over the amount of its relative speed: straight between its points, level beyond the last. */
static double @P@_drag_torque(const @P@_drag_data_t *drag, double slip)
{
    const uint32_t last = (uint32_t)drag->first + (uint32_t)drag->points - 1u;
    double torque = @P@_drag_points[drag->first][1];
    uint32_t k;

    for (k = (uint32_t)drag->first; k < last; k++) {
        const double x0 = @P@_drag_points[k][0];
        const double x1 = @P@_drag_points[k + 1u][0];
        if ((slip > x0) && (slip < x1)) {
            const double part = (slip - x0) / (x1 - x0);
            torque = @P@_drag_points[k][1] + (part * (@P@_drag_points[k + 1u][1] - @P@_drag_points[k][1]));
        } else if (slip >= x1) {
            torque = @P@_drag_points[k + 1u][1];
        } else {
            /* Below this piece. */
        }
    }
    return torque + (drag->viscous * slip);
}

/* Drags resist the relative speed of their two members; at rest they do nothing. */
static void @P@_drags(double inputs[@U@_X], @P@_result_t *result)
{
    uint32_t k;

    for (k = 0u; k < @U@_DRAGS; k++) {
        const @P@_drag_data_t *drag = &@P@_drag_table[k];
        double slip = 0.0;
        int known = 1;
        uint32_t side;
        for (side = 0u; side < 2u; side++) {
            const uint32_t member = (uint32_t)drag->member[side];
            if (member < @U@_MEMBERS) {
                slip += ((side == 0u) ? 1.0 : -1.0) * result->speed[member];
                if (result->speed_known[member] == 0u) {
                    known = 0;
                }
            }
        }
        if ((known == 1) && ((slip < 0.0) || (slip > 0.0))) {
            const double size = (slip < 0.0) ? -slip : slip;
            const double torque = @P@_drag_torque(drag, size);
            inputs[@U@_TORQUES + k] = (slip < 0.0) ? torque : -torque;
            result->drag_loss[k] = torque * size;
        }
    }
}

