model create model_name = crank
defaults units length = mm angle = deg force = newton mass = kg time = sec
defaults units coordinate_system_type = cartesian orientation_type = body123
variable create variable_name = .crank.r real_value = 50.0
marker create marker_name = .crank.ground.o adams_id = 1 location = 0,0,0
defaults coordinate_system default_coordinate_system = .crank.ground
for variable_name = k start_value = 1 end_value = 2
  part create rigid_body name_and_position part_name = (eval(".crank.p" // RTOI(k))) &
    location = (.crank.r * k), 0, 0 orientation = 0, 0, (30 * k)
  marker create marker_name = (eval(".crank.p" // RTOI(k) // ".cm")) location = (LOC_RELATIVE_TO({1, 2, 0}, .crank.ground.o)) &
    orientation = (ORI_ALONG_AXIS(.crank.ground.o, .crank.p1, "x"))
  part create rigid_body mass_properties part_name = (eval(".crank.p" // RTOI(k))) density = (7801(kg/meter**3))
  geometry create shape cylinder cylinder_name = (eval(".crank.p" // RTOI(k) // ".c")) length = 10.0 radius = 2 &
    center_marker = (eval(".crank.p" // RTOI(k) // ".cm"))
end
if condition = (.crank.r > 10 && db_exists(".crank.p1"))
  constraint create joint revolute joint_name = .crank.j i_marker_name = .crank.p1.cm j_marker_name = .crank.ground.o
else
  constraint create joint fixed joint_name = .crank.j i_part_name = .crank.p1 j_part_name = .crank.ground location = 1,2,3
end
measure create object measure_name = .crank.w object = .crank.p1 characteristic = cm_angular_velocity component = z_component
force create direct single_component_force single_component_force_name = .crank.f type_of_freedom = rotational &
  i_marker_name = .crank.p1.cm j_marker_name = .crank.ground.o action_only = on &
  function = "-0.1*.crank.w + ", &
             "STEP(TIME, 0, 0, 1, .crank.r)"
simulation single_run transient type = auto_select end_time = 1 number_of_steps = 10 initial_static = no
